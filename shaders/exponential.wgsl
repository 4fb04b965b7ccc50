// Share of the light at a depth, 0 to 1: falls by e for each 1/exponent that it lies behind.
fn antumbra_exponential_lit(stored: f32, depth: f32, exponent: f32) -> f32 {
    let behind = depth - stored;
    return select(1.0, exp(-exponent * behind), behind > 0.0);
}
