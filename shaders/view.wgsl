// What a receiver knows of one map. Filled by `ShadowFrame::uniforms`; the layout is `ViewUniforms`.
struct AntumbraView {
    // Rows: texture coordinates (times w) and w of a render-space position. w is 1 everywhere for an affine map.
    u_from_render: vec4f,
    v_from_render: vec4f,
    w_from_render: vec4f,
    // Row: light depth in [0, 1], linear in position.
    depth_from_render: vec4f,
    // One texel step in u and in v across the light, world units; w: depth per world unit, and its inverse.
    texel_u: vec4f,
    texel_v: vec4f,
    // Constant bias (depth), cosine of incidence that counts as grazing, texels that rounding adds to a filter's reach, manual
    // normal offset (world units).
    bias: vec4f,
    // The part of the map that is drawn, in texture coordinates: min, max. Texels outside stay lit.
    rect: vec4f,
}
