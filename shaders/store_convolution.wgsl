// What a texel of the filtered map stores of a depth, for two terms of the series, within 0 to 1.
fn antumbra_store(depth: f32) -> vec4f {
    return antumbra_convolution_terms(depth, antumbra_blur.first_term) * 0.5 + 0.5;
}
