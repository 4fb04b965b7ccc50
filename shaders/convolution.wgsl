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
