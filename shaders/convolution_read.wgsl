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
