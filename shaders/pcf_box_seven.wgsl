// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 4.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// One row of the box below: four x offsets with their weights.
fn antumbra_box_row_of_four(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup, x: vec4f, weight: vec4f, y: f32) -> f32 {
    return antumbra_tap(map, compare, look, vec2f(x.x, y)) * weight.x
        + antumbra_tap(map, compare, look, vec2f(x.y, y)) * weight.y
        + antumbra_tap(map, compare, look, vec2f(x.z, y)) * weight.z
        + antumbra_tap(map, compare, look, vec2f(x.w, y)) * weight.w;
}

// A box seven texels wide around the receiver. Along an axis it weighs eight texels (1 - f, 1, 1, 1, 1, 1, 1, f) / 7,
// which four bilinear taps can do, each between two of them.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    let f = fract(look.uv * vec2f(textureDimensions(map)) - 0.5);
    let first = 1.0 / (2.0 - f) - 3.0 - f;
    let last = f / (1.0 + f) + 3.0 - f;
    let x = vec4f(first.x, -0.5 - f.x, 1.5 - f.x, last.x);
    let weight = vec4f(2.0 - f.x, 2.0, 2.0, 1.0 + f.x);
    return (antumbra_box_row_of_four(map, compare, look, x, weight, first.y) * (2.0 - f.y)
        + antumbra_box_row_of_four(map, compare, look, x, weight, -0.5 - f.y) * 2.0
        + antumbra_box_row_of_four(map, compare, look, x, weight, 1.5 - f.y) * 2.0
        + antumbra_box_row_of_four(map, compare, look, x, weight, last.y) * (1.0 + f.y)) / 49.0;
}
