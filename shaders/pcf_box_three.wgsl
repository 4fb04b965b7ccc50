// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 2.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// A box three texels wide around the receiver. Along an axis it weighs four texels (1 - f, 1, 1, f) / 3, which two
// bilinear taps can do: one between the first two, one between the last two.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    let f = fract(look.uv * vec2f(textureDimensions(map)) - 0.5);
    let first = 1.0 / (2.0 - f) - 1.0 - f;
    let last = f / (1.0 + f) + 1.0 - f;
    let lower = antumbra_tap(map, compare, look, first) * (2.0 - f.x)
        + antumbra_tap(map, compare, look, vec2f(last.x, first.y)) * (1.0 + f.x);
    let upper = antumbra_tap(map, compare, look, vec2f(first.x, last.y)) * (2.0 - f.x)
        + antumbra_tap(map, compare, look, last) * (1.0 + f.x);
    return (lower * (2.0 - f.y) + upper * (1.0 + f.y)) / 9.0;
}
