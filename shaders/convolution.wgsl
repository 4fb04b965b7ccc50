// Depths are stored within this share of half the period of the series: at all of it near and far are one.
const ANTUMBRA_CONVOLUTION_RANGE: f32 = 0.9;

// Angular frequency of a term, from 0 on.
fn antumbra_convolution_frequency(term: u32) -> f32 {
    return 3.14159265 * f32(2u * term + 1u);
}

// What a texel stores of a depth for two terms of the series, `term` and the next: cosine and sine of each.
fn antumbra_convolution_terms(depth: f32, term: u32) -> vec4f {
    let at = depth * ANTUMBRA_CONVOLUTION_RANGE;
    let first = antumbra_convolution_frequency(term) * at;
    let second = antumbra_convolution_frequency(term + 1u) * at;
    return vec4f(cos(first), sin(first), cos(second), sin(second));
}

// What two terms add to the step from shadow to light at a depth: start from one half.
fn antumbra_convolution_part(terms: vec4f, depth: f32, term: u32) -> f32 {
    let at = antumbra_convolution_terms(depth, term);
    let first = (at.x * terms.y - at.y * terms.x) / antumbra_convolution_frequency(term);
    let second = (at.z * terms.w - at.w * terms.z) / antumbra_convolution_frequency(term + 1u);
    return 2.0 * (first + second);
}

// Share of the light from the sum of the series, 0 to 1: at a receiver's own depth the sum is one half, which is lit.
fn antumbra_convolution_lit(sum: f32) -> f32 {
    return select(1.0, clamp(2.0 * sum, 0.0, 1.0), sum < 0.5);
}
