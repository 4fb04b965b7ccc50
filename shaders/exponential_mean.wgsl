// Part of a mean of exponentials of depth, which is kept as a logarithm, so that no exponent overflows: weights by how
// many times less than the farthest of the depths each weighs. farthest: of all the depths.
fn antumbra_exponential_part(depth: f32, farthest: f32, exponent: f32) -> f32 {
    return exp(exponent * (depth - farthest));
}

// The mean of depths, from the sum of their weighted parts.
fn antumbra_exponential_mean(sum: f32, farthest: f32, exponent: f32) -> f32 {
    return farthest + log(max(sum, ANTUMBRA_EXPONENTIAL_LEAST)) / exponent;
}

// Below every sum of parts, of which the farthest has one; keeps the logarithm finite.
const ANTUMBRA_EXPONENTIAL_LEAST: f32 = 1e-37;
