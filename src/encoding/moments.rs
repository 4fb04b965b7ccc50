//! Four moments of depth: the Rust twins of `shaders/moments.wgsl`, `moments_hamburger.wgsl`, `moments_hausdorff.wgsl`,
//! `moments_lit.wgsl`, `moments_stored.wgsl`, `moments_packed.wgsl` and `moments_unpacked.wgsl`.
//!
//! Of all distributions of depth with the given moments, the one with the least share before the receiver gives the
//! shadow: it is never too dark. On the whole line (Hamburger) its depths are the receiver's and two roots; within the
//! map's range (Hausdorff), where a root would lie outside, they are the receiver's, both ends, and one more:
//!
//! ```text
//! (1)  B c = (1, z, z²),  B = [1 b₁ b₂; b₁ b₂ b₃; b₂ b₃ b₄],  roots of c₀ + c₁ x + c₂ x²
//! (2)  z' = (b₂ − b₄ − z (b₁ − b₃)) / (b₁ − b₃ − z (1 − b₂)), from ∫ (1 − x²)(x − z)(x − z') = 0
//! ```
//!
//! Three surfaces of any depths are exact but for the receiver's own.
//!
//! # Numbers
//! Depths are taken on [−1, 1], and pivots of (1) are kept above what unfused f32 loses: on [0, 1], without fused
//! multiply-add, 8 % of lone surfaces read wrong. Roots are computed without cancellation.
//!
//! # References
//! - Peters & Klein, *Moment shadow mapping*, 2015, algorithms 1 and 2.
//! - Peters, Münstermann, Wetzstein & Klein, *Improved moment shadow maps for translucent occluders, soft shadows and
//!   single scattering*, 2017 (16 bits).
//! - `MATH.md` section 7; section 10 row 22.

use glam::{Vec2, Vec4, Vec4Swizzles};

/// Share of a spread distribution that is mixed in, for moments of 32 bits.
pub const ANTUMBRA_MOMENTS_BIAS: f32 = 1e-6;

/// Twin of the shader's constant: least variance.
const ANTUMBRA_MOMENTS_VARIANCE: f32 = 1e-7;

/// Twin of the shader's constant: least third pivot for each unit of variance.
const ANTUMBRA_MOMENTS_PIVOT: f32 = 1e-10;

/// Twin of the shader's constant: below every divisor that matters.
const ANTUMBRA_MOMENTS_SMALLEST: f32 = 1e-30;

/// Twin of the shader's constant: before this depth, on [−1, 1], nothing is in shadow.
const ANTUMBRA_MOMENTS_NEAREST: f32 = -0.999_99;

/// Twin of the shader's constant: what rounding takes from the means of (2).
const ANTUMBRA_MOMENTS_LOSS: f32 = 1e-6;

/// Twin of `antumbra_moments`: what a texel stores of a depth.
#[must_use]
pub fn antumbra_moments(depth: f32) -> Vec4 {
    let z = 2.0 * depth - 1.0;
    let square = z * z;
    Vec4::new(z, square, square * z, square * square)
}

/// Twin of `antumbra_moments_sound`: moments that belong to some distribution.
#[must_use]
pub fn antumbra_moments_sound(moments: Vec4, bias: f32) -> Vec4 {
    moments * (1.0 - bias) + Vec4::new(0.0, 0.375, 0.0, 0.375) * bias
}

/// Twin of `antumbra_moments_divisor`: a divisor that is not zero.
#[must_use]
pub fn antumbra_moments_divisor(value: f32) -> f32 {
    if value >= 0.0 { value.max(ANTUMBRA_MOMENTS_SMALLEST) } else { value.min(-ANTUMBRA_MOMENTS_SMALLEST) }
}

/// Twin of `antumbra_moments_roots`: the two other depths of (1), less and greater.
#[must_use]
pub fn antumbra_moments_roots(b: Vec4, z: f32) -> Vec2 {
    let lower = b.z - b.x * b.y;
    let second = (b.y - b.x * b.x).max(ANTUMBRA_MOMENTS_VARIANCE);
    let third = ((b.w - b.y * b.y) * second - lower * lower).max(ANTUMBRA_MOMENTS_PIVOT * second);
    let ratio = lower / second;
    let one = z - b.x;
    let two = z * z - b.y - ratio * one;
    let c_two = two * second / third;
    let c_one = one / second - ratio * c_two;
    let c_zero = 1.0 - c_one * b.x - c_two * b.y;
    let half = (c_one * c_one - 4.0 * c_two * c_zero).max(0.0).sqrt();
    let whole = -0.5 * (c_one + if c_one >= 0.0 { half } else { -half });
    let far = whole / antumbra_moments_divisor(c_two);
    let near = c_zero / antumbra_moments_divisor(whole);
    Vec2::new(near.min(far), near.max(far))
}

/// Twin of `antumbra_moments_least`: least share before `z` of any distribution on the line, given the roots.
#[must_use]
pub fn antumbra_moments_least(b: Vec4, z: f32, roots: Vec2) -> f32 {
    if !(z > roots.x) {
        return 0.0;
    }
    let between = z <= roots.y;
    let (other, last) = if between { (roots.y, z) } else { (roots.x, roots.y) };
    let spread = (z - roots.x) * if between { roots.y - roots.x } else { z - roots.y };
    let weight = (other * last - b.x * (other + last) + b.y) / antumbra_moments_divisor(spread);
    let share = if between { weight } else { 1.0 - weight };
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}

/// Twin of `antumbra_moments_least_within`: least share before `z` of any distribution on [−1, 1] whose least one on
/// the line reaches beyond.
#[must_use]
pub fn antumbra_moments_least_within(b: Vec4, z: f32) -> f32 {
    if !(z > ANTUMBRA_MOMENTS_NEAREST) {
        return 0.0;
    }
    let divisor = antumbra_moments_divisor(b.x - b.z - z * (1.0 - b.y));
    let other = ((b.y - b.w - z * (b.x - b.z)) / divisor).clamp(-1.0, 1.0);
    let rest = b.z - other * b.y - b.x + other;
    let before = other < z;
    let square = if before { -0.5 / antumbra_moments_divisor(1.0 - other) } else { 0.5 / (1.0 + other) };
    let cubic = if before {
        0.5 * (2.0 + z - other) / antumbra_moments_divisor((1.0 - other) * (z - other) * (1.0 + z))
    } else {
        -0.5 / ((1.0 + other) * (1.0 + z))
    };
    let apart = antumbra_moments_divisor((1.0 - other * other) * (other - z) * (other - z));
    let share = 0.5 * (1.0 - b.x) + square * (b.y - 1.0) + cubic * rest - ANTUMBRA_MOMENTS_LOSS / apart;
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}

/// Twin of `antumbra_moments_lit`: share of the light at a depth, 0 to 1 (Hamburger). `bias` is
/// [`ANTUMBRA_MOMENTS_BIAS`] for 32 bits.
#[must_use]
pub fn antumbra_moments_lit(moments: Vec4, depth: f32, bias: f32) -> f32 {
    let b = antumbra_moments_sound(moments, bias);
    let z = 2.0 * depth - 1.0;
    1.0 - antumbra_moments_least(b, z, antumbra_moments_roots(b, z))
}

/// Twin of `antumbra_moments_lit_within`: the same for depths known to be in [0, 1] (Hausdorff).
#[must_use]
pub fn antumbra_moments_lit_within(moments: Vec4, depth: f32, bias: f32) -> f32 {
    let b = antumbra_moments_sound(moments, bias);
    let z = 2.0 * depth - 1.0;
    let roots = antumbra_moments_roots(b, z);
    let least = antumbra_moments_least(b, z, roots);
    if roots.x < -1.0 || roots.y > 1.0 {
        return 1.0 - least.max(antumbra_moments_least_within(b, z));
    }
    1.0 - least
}

/// Twin of `antumbra_moments_packed`: an even mixture of moments, each 0 to 1, for 16 bits.
#[must_use]
pub fn antumbra_moments_packed(b: Vec4) -> Vec4 {
    Vec4::new(
        1.5 * b.x - 2.0 * b.z + 0.5,
        0.866_025_4 * b.x - 0.384_900_18 * b.z + 0.5,
        4.0 * (b.y - b.w),
        0.5 * (b.y + b.w),
    )
}

/// Twin of `antumbra_moments_unpacked`: and back.
#[must_use]
pub fn antumbra_moments_unpacked(stored: Vec4) -> Vec4 {
    let odd = stored.xy() - 0.5;
    Vec4::new(
        -0.333_333_33 * odd.x + 1.732_050_8 * odd.y,
        0.125 * stored.z + stored.w,
        -0.75 * odd.x + 1.299_038 * odd.y,
        -0.125 * stored.z + stored.w,
    )
}
