// Nearer to the near end of the range than this nothing can be in shadow: rounding divided by the rest would decide.
const ANTUMBRA_MOMENTS_NEAREST: f32 = -0.99999;

// What rounding takes from the means below: given back to the light, so that the bound holds where depths come
// together.
const ANTUMBRA_MOMENTS_LOSS: f32 = 1e-6;

// Least share of any distribution on [-1, 1] with four moments `b` that lies before `z`, where the least one on the
// whole line reaches beyond: its depths are both ends, z, and one more.
fn antumbra_moments_least_within(b: vec4f, z: f32) -> f32 {
    if (!(z > ANTUMBRA_MOMENTS_NEAREST)) {
        return 0.0;
    }
    let other = clamp((b.y - b.w - z * (b.x - b.z)) / antumbra_moments_divisor(b.x - b.z - z * (1.0 - b.y)), -1.0, 1.0);
    // The mean of the cubic that is 1 at depths before z and 0 at the others: Newton's form from the ends inwards, in
    // which depths may come together.
    let rest = b.z - other * b.y - b.x + other;
    let before = other < z;
    let square = select(0.5 / (1.0 + other), -0.5 / antumbra_moments_divisor(1.0 - other), before);
    let cubic = select(
        -0.5 / ((1.0 + other) * (1.0 + z)),
        0.5 * (2.0 + z - other) / antumbra_moments_divisor((1.0 - other) * (z - other) * (1.0 + z)),
        before,
    );
    // The other depth is as uncertain as its own mean is over how far it is from z.
    let apart = antumbra_moments_divisor((1.0 - other * other) * (other - z) * (other - z));
    let share = 0.5 * (1.0 - b.x) + square * (b.y - 1.0) + cubic * rest - ANTUMBRA_MOMENTS_LOSS / apart;
    return select(0.0, min(share, 1.0), share > 0.0);
}

// Share of the light at a depth, 0 to 1, by four moments of depths that are known to be in the map's range: a bound
// from above (Hausdorff), never above Hamburger's.
fn antumbra_moments_lit_within(moments: vec4f, depth: f32, bias: f32) -> f32 {
    let b = antumbra_moments_sound(moments, bias);
    let z = 2.0 * depth - 1.0;
    let roots = antumbra_moments_roots(b, z);
    let least = antumbra_moments_least(b, z, roots);
    if (roots.x < -1.0 || roots.y > 1.0) {
        return 1.0 - max(least, antumbra_moments_least_within(b, z));
    }
    return 1.0 - least;
}
