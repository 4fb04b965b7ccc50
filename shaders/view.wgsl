// What a receiver knows of one map. Filled by `ShadowFrame::uniforms`; the layout is `ViewUniforms`.
struct AntumbraView {
    // Rows: texture coordinates (times w) and w of a render-space position. w is 1 everywhere for an affine map.
    u_from_render: vec4f,
    v_from_render: vec4f,
    w_from_render: vec4f,
    // Row: light depth in [0, 1], linear in position, less the constant bias.
    depth_from_render: vec4f,
    // Fall of a plane over one texel step in u and in v, for each unit of dot(row, normal); square of the depth per
    // world unit; size of dot(depth row, normal) below which a surface grazes the light.
    texel: vec4f,
    // Texels that rounding adds to a filter's reach, manual normal offset (world units), by how much of itself a texel
    // of a warped map outgrows its neighbours for each unit of w, side of a texel (texture coordinates).
    bias: vec4f,
    // The part of the map that is drawn, in texture coordinates: min, max. Texels outside stay lit.
    rect: vec4f,
    // Warped maps: what the fall of a plane over a texel step is made of (lookup_projective.wgsl), x to z. The last
    // members: layer of the map; eye depth at which several maps that are found by containment begin to give way to
    // light, and one over the length of that band (both of the first view).
    across_u: vec4f,
    across_v: vec4f,
    across_w: vec4f,
    // Several maps: nearest and farthest eye depth that the view serves. By depth: where it begins to give way to the
    // next one, and one over the length of that band. By containment, in texture coordinates: what a filter reads
    // beyond a receiver, and one over the width of the band along the rim in which it gives way.
    domain: vec4f,
    // Maps of moments: texels over a pixel where w is 1, a row; light that is taken for bleeding, last level, lift for
    // a wider texel of a level as a share of it, half-width of the blur (world units, or texels, negated). Penumbras:
    // world units of radius for each unit of linear light depth between caster and receiver, widest radius in texels.
    // Filters of the pixel: its size in world units, a row; the eye and 1, or the direction to it and 0.
    pixel_from_render: vec4f,
    moments: vec4f,
}
