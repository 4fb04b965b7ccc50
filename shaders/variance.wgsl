// Share of the light at a depth by two moments of depth: a bound from above. loss: what rounding may have taken from
// the variance, more than 0.
fn antumbra_variance_lit(moments: vec2f, depth: f32, loss: f32) -> f32 {
    return antumbra_chebyshev(moments, depth - 0.5, loss);
}
