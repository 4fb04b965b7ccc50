// Least variance, and the least third pivot for each unit of it: below, depths are one. Products of f32 that are not
// fused lose as much.
const ANTUMBRA_MOMENTS_VARIANCE: f32 = 1e-7;
const ANTUMBRA_MOMENTS_PIVOT: f32 = 1e-10;

// Below every divisor that matters; keeps roots and shares finite.
const ANTUMBRA_MOMENTS_SMALLEST: f32 = 1e-30;

// Moments that belong to some distribution, whatever rounding has made of them.
fn antumbra_moments_sound(moments: vec4f, bias: f32) -> vec4f {
    return mix(moments, vec4f(0.0, 0.375, 0.0, 0.375), bias);
}

// The two other depths of the least distribution of three that has these moments and `z`: less, greater.
fn antumbra_moments_roots(b: vec4f, z: f32) -> vec2f {
    // Cholesky factors of the Hankel matrix.
    let lower = b.z - b.x * b.y;
    let second = max(b.y - b.x * b.x, ANTUMBRA_MOMENTS_VARIANCE);
    let third = max((b.w - b.y * b.y) * second - lower * lower, ANTUMBRA_MOMENTS_PIVOT * second);
    let ratio = lower / second;
    // Solve for the quadratic.
    let one = z - b.x;
    let two = z * z - b.y - ratio * one;
    let c_two = two * second / third;
    let c_one = one / second - ratio * c_two;
    let c_zero = 1.0 - c_one * b.x - c_two * b.y;
    // Its roots, the one that does not cancel first.
    let half = sqrt(max(c_one * c_one - 4.0 * c_two * c_zero, 0.0));
    let whole = -0.5 * (c_one + select(-half, half, c_one >= 0.0));
    let far = whole / antumbra_moments_divisor(c_two);
    let near = c_zero / antumbra_moments_divisor(whole);
    return vec2f(min(near, far), max(near, far));
}

// A divisor that is not zero.
fn antumbra_moments_divisor(value: f32) -> f32 {
    return select(min(value, -ANTUMBRA_MOMENTS_SMALLEST), max(value, ANTUMBRA_MOMENTS_SMALLEST), value >= 0.0);
}
