// What a texel stores of a depth: two moments about the middle of the range, where they are smallest.
fn antumbra_variance_moments(depth: f32) -> vec2f {
    let centred = depth - 0.5;
    return vec2f(centred, centred * centred);
}
