// What a texel stores of a depth: the depth itself. Its mean is one of exponentials, taken as a logarithm, so that no
// exponent overflows.
fn antumbra_exponential_moments(depth: f32) -> f32 {
    return depth;
}

// Part of such a mean: weights by how many times less than the farthest of the depths each weighs.
// farthest: of all the depths.
fn antumbra_exponential_part(depth: f32, farthest: f32, exponent: f32) -> f32 {
    return exp(exponent * (depth - farthest));
}

// The mean of depths, from the sum of their weighted parts.
fn antumbra_exponential_mean(sum: f32, farthest: f32, exponent: f32) -> f32 {
    return farthest + log(max(sum, ANTUMBRA_EXPONENTIAL_LEAST)) / exponent;
}

// Below every sum of parts, of which the farthest has one; keeps the logarithm finite.
const ANTUMBRA_EXPONENTIAL_LEAST: f32 = 1e-37;

// Share of the light at a depth, 0 to 1: falls by e for each 1/exponent that it lies behind.
fn antumbra_exponential_lit(stored: f32, depth: f32, exponent: f32) -> f32 {
    let behind = depth - stored;
    return select(1.0, exp(-exponent * behind), behind > 0.0);
}
