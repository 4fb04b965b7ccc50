//! Exponentials of depth: the Rust twins of `shaders/exponential*.wgsl`.
//!
//! ```text
//! (1)  ESM    lit = min(1, e^(c (z̄ − t))),  z̄ = (1/c) ln Σ wᵢ e^(c zᵢ)
//! (2)  EVSM   w⁺ = e^(c⁺(2z − 1)),  w⁻ = −e^(−c⁻(2z − 1)); the lesser of both Chebyshev bounds
//! (3)  loss   (blur · dw/dz)²,  dw/dz = 2 c w
//! ```
//!
//! (1) assumes that what is filtered lies in front of the receiver: light leaks where shadows touch their casters,
//! over a depth of 1/c. It is stored as z̄, which overflows for no c. (2) bends near depths apart before variance is
//! taken, so that overlapping casters look like one; the negative side sees to contacts.
//!
//! # Where this differs from common practice
//! - Sample code scales what it adds by c·w: (3) has the factor 2 that d(2z − 1)/dz is.
//!
//! # References
//! - Annen, Mertens, Seidel, Flerackers & Kautz, *Exponential shadow maps*, 2008.
//! - Lauritzen & `McCool`, *Layered variance shadow maps*, 2008, section 4.
//! - `MATH.md` section 7; section 10 row 20.

use glam::{Vec2, Vec4, Vec4Swizzles};

use super::variance::antumbra_chebyshev;

/// Twin of the shader's constant: below every sum of parts.
const ANTUMBRA_EXPONENTIAL_LEAST: f32 = 1e-37;

/// Twin of `antumbra_exponential_moments`: what a texel stores of a depth is the depth.
#[must_use]
pub fn antumbra_exponential_moments(depth: f32) -> f32 {
    depth
}

/// Twin of `antumbra_exponential_part`: by how much less than the farthest of the depths one weighs.
#[must_use]
pub fn antumbra_exponential_part(depth: f32, farthest: f32, exponent: f32) -> f32 {
    (exponent * (depth - farthest)).exp()
}

/// Twin of `antumbra_exponential_mean`: the mean of depths, from the sum of their weighted parts.
#[must_use]
pub fn antumbra_exponential_mean(sum: f32, farthest: f32, exponent: f32) -> f32 {
    farthest + sum.max(ANTUMBRA_EXPONENTIAL_LEAST).ln() / exponent
}

/// Twin of `antumbra_exponential_lit`: share of the light at a depth, 0 to 1; `exponent` is c, per depth range.
#[must_use]
pub fn antumbra_exponential_lit(stored: f32, depth: f32, exponent: f32) -> f32 {
    let behind = depth - stored;
    if behind > 0.0 { (-exponent * behind).exp() } else { 1.0 }
}

/// Twin of `antumbra_warped_depth`: w⁺ and w⁻ of a depth.
#[must_use]
pub fn antumbra_warped_depth(depth: f32, exponents: Vec2) -> Vec2 {
    let centred = 2.0 * depth - 1.0;
    Vec2::new((exponents.x * centred).exp(), -(-exponents.y * centred).exp())
}

/// Twin of `antumbra_exponential_variance_moments`: w⁺, its square, w⁻, its square.
#[must_use]
pub fn antumbra_exponential_variance_moments(depth: f32, exponents: Vec2) -> Vec4 {
    let warped = antumbra_warped_depth(depth, exponents);
    Vec4::new(warped.x, warped.x * warped.x, warped.y, warped.y * warped.y)
}

/// Twin of `antumbra_exponential_variance_lit_two`: by the first two moments alone (EVSM2). `blur` is the standard
/// deviation of depths that rounding makes, share of the depth range, more than 0.
#[must_use]
pub fn antumbra_exponential_variance_lit_two(moments: Vec2, depth: f32, exponents: Vec2, blur: f32) -> f32 {
    let warped = antumbra_warped_depth(depth, exponents).x;
    let step = blur * 2.0 * exponents.x * warped;
    antumbra_chebyshev(moments, warped, step * step)
}

/// Twin of `antumbra_exponential_variance_lit`: the lesser of both bounds (EVSM4).
#[must_use]
pub fn antumbra_exponential_variance_lit(moments: Vec4, depth: f32, exponents: Vec2, blur: f32) -> f32 {
    let warped = antumbra_warped_depth(depth, exponents);
    let step = blur * 2.0 * exponents * warped;
    let positive = antumbra_chebyshev(moments.xy(), warped.x, step.x * step.x);
    let negative = antumbra_chebyshev(moments.zw(), warped.y, step.y * step.y);
    positive.min(negative)
}
