// Greatest share of any distribution with these two moments that lies at a value or beyond it (Chebyshev's one-sided
// inequality), 0 to 1. loss: what rounding may have taken from the variance, more than 0: it is given back, so that the
// bound holds. What is not a number reads lit.
fn antumbra_chebyshev(moments: vec2f, value: f32, loss: f32) -> f32 {
    let variance = moments.y - moments.x * moments.x;
    let spread = select(0.0, variance, variance > 0.0) + loss;
    let beyond = value - moments.x;
    let lit = spread / (spread + beyond * beyond);
    return select(1.0, lit, beyond > 0.0 && lit < 1.0);
}
