// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 3.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// One row of the box below: x offsets first, middle, last with their weights.
fn antumbra_box_row(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup, x: vec3f, weight: vec3f, y: f32) -> f32 {
    return antumbra_tap(map, compare, look, vec2f(x.x, y)) * weight.x
        + antumbra_tap(map, compare, look, vec2f(x.y, y)) * weight.y
        + antumbra_tap(map, compare, look, vec2f(x.z, y)) * weight.z;
}

// A box five texels wide around the receiver. Along an axis it weighs six texels (1 - f, 1, 1, 1, 1, f) / 5, which
// three bilinear taps can do, each between two of them.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    let f = fract(look.uv * vec2f(textureDimensions(map)) - 0.5);
    let first = 1.0 / (2.0 - f) - 2.0 - f;
    let middle = 0.5 - f;
    let last = f / (1.0 + f) + 2.0 - f;
    let x = vec3f(first.x, middle.x, last.x);
    let weight = vec3f(2.0 - f.x, 2.0, 1.0 + f.x);
    return (antumbra_box_row(map, compare, look, x, weight, first.y) * (2.0 - f.y)
        + antumbra_box_row(map, compare, look, x, weight, middle.y) * 2.0
        + antumbra_box_row(map, compare, look, x, weight, last.y) * (1.0 + f.y)) / 25.0;
}
