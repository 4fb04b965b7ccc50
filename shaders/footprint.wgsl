// Below every extent in texels that matters; keeps a point without one from dividing by zero.
const ANTUMBRA_FOOTPRINT_SMALLEST: f32 = 1e-30;

// Debug view: texels over a pixel in the direction in which there are fewest. 1 or more means no aliasing; 0 that there
// is no map here, or a surface that the light only grazes.
// side: of the map, texels. The derivatives come in: dpdx(position) and dpdy(position), where all fragments take them.
fn antumbra_footprint(view: AntumbraView, side: f32, position: vec3f, d_position_dx: vec3f, d_position_dy: vec3f) -> f32 {
    let at = vec4f(position, 1.0);
    let w = dot(view.w_from_render, at);
    let from_w = select(0.0, 1.0 / w, w > 0.0);
    let uv = vec2f(dot(view.u_from_render, at), dot(view.v_from_render, at)) * from_w;
    // How texel coordinates change over the world, and from there over the picture.
    let u = (view.u_from_render.xyz - uv.x * view.w_from_render.xyz) * (side * from_w);
    let v = (view.v_from_render.xyz - uv.y * view.w_from_render.xyz) * (side * from_w);
    let along_x = vec2f(dot(u, d_position_dx), dot(v, d_position_dx));
    let along_y = vec2f(dot(u, d_position_dy), dot(v, d_position_dy));
    // Singular values: these two lengths are their sum and their difference, and the determinant is their product.
    let turned = vec2f(along_y.y, -along_y.x);
    let longest = 0.5 * (length(along_x + turned) + length(along_x - turned));
    let shortest = abs(dot(along_x, turned / max(longest, ANTUMBRA_FOOTPRINT_SMALLEST)));
    let inside = w > 0.0 && all(uv >= view.rect.xy) && all(uv <= view.rect.zw);
    return select(0.0, shortest, inside);
}

// Factors of two from 1 texel per pixel to the ends of the scale of colours.
const ANTUMBRA_FOOTPRINT_OCTAVES: f32 = 4.0;

// The colour of a footprint, sRGB: white at 1 texel per pixel, red where there are fewer (blocks), blue where there are
// more; grey for 0.
fn antumbra_footprint_colour(texels_per_pixel: f32) -> vec3f {
    let place = log2(max(texels_per_pixel, ANTUMBRA_FOOTPRINT_SMALLEST)) / ANTUMBRA_FOOTPRINT_OCTAVES;
    let off = min(abs(place), 1.0);
    let few = place < 0.0;
    let middle = select(vec3f(0.40, 0.66, 0.81), vec3f(0.96, 0.65, 0.48), few);
    let end = select(vec3f(0.08, 0.30, 0.56), vec3f(0.64, 0.05, 0.15), few);
    let colour = mix(mix(vec3f(0.97), middle, min(2.0 * off, 1.0)), end, max(2.0 * off - 1.0, 0.0));
    return select(vec3f(0.35), colour, texels_per_pixel > 0.0);
}
