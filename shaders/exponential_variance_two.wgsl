// Share of the light at a depth by the moments of the first bent depth alone: a bound from above.
// blur: standard deviation of depths that rounding alone makes, more than 0.
fn antumbra_exponential_variance_lit_two(moments: vec2f, depth: f32, exponents: vec2f, blur: f32) -> f32 {
    let warped = antumbra_warped_depth(depth, exponents).x;
    let step = blur * 2.0 * exponents.x * warped;
    return antumbra_chebyshev(moments, warped, step * step);
}
