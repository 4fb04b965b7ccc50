// What a texel of the filtered map stores of a depth: of two channels the first two are kept.
fn antumbra_store(depth: f32) -> vec4f {
    return antumbra_exponential_variance_moments(depth, ANTUMBRA_EXPONENTS);
}
