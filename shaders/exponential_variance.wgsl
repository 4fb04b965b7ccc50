// Depth, bent twice: x grows with depth and tells near casters apart from far receivers, y grows as well but is negative,
// and does so from the other end. exponents: of both, at most half the logarithm of the largest number stored.
fn antumbra_warped_depth(depth: f32, exponents: vec2f) -> vec2f {
    let centred = 2.0 * depth - 1.0;
    return vec2f(exp(exponents.x * centred), -exp(-exponents.y * centred));
}

// What a texel stores of a depth: both bent depths and their squares.
fn antumbra_exponential_variance_moments(depth: f32, exponents: vec2f) -> vec4f {
    let warped = antumbra_warped_depth(depth, exponents);
    return vec4f(warped.x, warped.x * warped.x, warped.y, warped.y * warped.y);
}

// Share of the light at a depth by the moments of the first bent depth alone: a bound from above.
// blur: standard deviation of depths that rounding alone makes, more than 0.
fn antumbra_exponential_variance_lit_two(moments: vec2f, depth: f32, exponents: vec2f, blur: f32) -> f32 {
    let warped = antumbra_warped_depth(depth, exponents).x;
    let step = blur * 2.0 * exponents.x * warped;
    return antumbra_chebyshev(moments, warped, step * step);
}

// By both: the lesser of two bounds.
fn antumbra_exponential_variance_lit(moments: vec4f, depth: f32, exponents: vec2f, blur: f32) -> f32 {
    let warped = antumbra_warped_depth(depth, exponents);
    let step = blur * 2.0 * exponents * warped;
    let positive = antumbra_chebyshev(moments.xy, warped.x, step.x * step.x);
    let negative = antumbra_chebyshev(moments.zw, warped.y, step.y * step.y);
    return min(positive, negative);
}
