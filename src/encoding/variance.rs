//! Two moments of depth: the Rust twins of `shaders/chebyshev.wgsl`, `darkened.wgsl` and `variance*.wgsl`.
//!
//! ```text
//! (1)  μ = M₁,  σ² = max(M₂ − M₁², 0) + loss
//! (2)  lit ≤ p(t) = σ²/(σ² + (t − μ)²) for t > μ, else 1
//! ```
//!
//! Exact where all casters are at one depth and all else at another; where casters overlap, σ² is large and light
//! shines through what the first of them hides (light bleeding). Moments are taken about the middle of the depth range:
//! the difference in (1) is of numbers four times smaller, and loses as much less. What it may lose is added, not taken
//! as a least value: (2) is then a bound whatever rounding did.
//!
//! # Where this differs from print
//! - TH-13: "shadowed with intensity p": p bounds the share that is *lit*.
//! - TH-14: "bleeding where σ² ≈ 0": it appears where σ² is large; σ² ≈ 0 is where rounding shows as acne.
//!
//! # References
//! - Donnelly & Lauritzen, *Variance shadow maps*, 2006, eq. 5.
//! - Lauritzen, *Summed-area variance shadow maps*, GPU Gems 3, 2007 (reducing light bleeding).
//! - `MATH.md` section 7; section 10 row 19.

use glam::Vec2;

/// Twin of `antumbra_chebyshev`: greatest share of any distribution with these two moments at `value` or beyond it.
#[must_use]
pub fn antumbra_chebyshev(moments: Vec2, value: f32, loss: f32) -> f32 {
    let variance = moments.y - moments.x * moments.x;
    let spread = if variance > 0.0 { variance } else { 0.0 } + loss;
    let beyond = value - moments.x;
    let lit = spread / (spread + beyond * beyond);
    if beyond > 0.0 && lit < 1.0 { lit } else { 1.0 }
}

/// Twin of `antumbra_darkened`: shares up to `dark` are none, the rest is stretched. `dark` is 0 to below 1.
#[must_use]
pub fn antumbra_darkened(lit: f32, dark: f32) -> f32 {
    ((lit - dark) / (1.0 - dark)).clamp(0.0, 1.0)
}

/// Twin of `antumbra_variance_moments`: what a texel stores of a depth.
#[must_use]
pub fn antumbra_variance_moments(depth: f32) -> Vec2 {
    let centred = depth - 0.5;
    Vec2::new(centred, centred * centred)
}

/// Twin of `antumbra_variance_lit`: share of the light at a depth, 0 to 1. `loss` is what rounding may have taken from
/// the variance, more than 0.
#[must_use]
pub fn antumbra_variance_lit(moments: Vec2, depth: f32, loss: f32) -> f32 {
    antumbra_chebyshev(moments, depth - 0.5, loss)
}

/// Twin of `antumbra_variance_packed`: two moments as integers keep them best, each 0 to 1.
#[must_use]
pub fn antumbra_variance_packed(moments: Vec2) -> Vec2 {
    Vec2::new(moments.x + 0.5, 4.0 * moments.y)
}

/// Twin of `antumbra_variance_unpacked`: and back.
#[must_use]
pub fn antumbra_variance_unpacked(stored: Vec2) -> Vec2 {
    Vec2::new(stored.x - 0.5, 0.25 * stored.y)
}
