// Share of the light at a depth by the moments of both bent depths: the lesser of two bounds from above.
// blur: standard deviation of depths that rounding alone makes, more than 0.
fn antumbra_exponential_variance_lit(moments: vec4f, depth: f32, exponents: vec2f, blur: f32) -> f32 {
    let warped = antumbra_warped_depth(depth, exponents);
    let step = blur * 2.0 * exponents * warped;
    let positive = antumbra_chebyshev(moments.xy, warped.x, step.x * step.x);
    let negative = antumbra_chebyshev(moments.zw, warped.y, step.y * step.y);
    return min(positive, negative);
}
