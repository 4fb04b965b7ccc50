// What a texel stores of a depth: both bent depths and their squares.
fn antumbra_exponential_variance_moments(depth: f32, exponents: vec2f) -> vec4f {
    let warped = antumbra_warped_depth(depth, exponents);
    return vec4f(warped.x, warped.x * warped.x, warped.y, warped.y * warped.y);
}
