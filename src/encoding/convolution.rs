//! A Fourier series of the step between shadow and light: the Rust twins of `shaders/convolution*.wgsl`.
//!
//! ```text
//! (1)  s(t) = ½ + 2 Σ_{k=1..M} (1/c_k) (cos(c_k t) ⟨sin(c_k z)⟩ − sin(c_k t) ⟨cos(c_k z)⟩),  c_k = π (2k − 1)
//! (2)  lit = 2 s where s < ½, else 1
//! ```
//!
//! The sines and cosines are filtered; two terms take four numbers. The step is as steep as M terms make it: slope 2M,
//! overshoot 9 % at 1/(2M) (ringing). At the receiver's own depth s = ½, which (2) makes lit: shadows begin to fade 1/M
//! of the range before their casters. The series has period 2, so that depths are scaled to 0.9: at 1, far and near
//! would be one.
//!
//! # References
//! - Annen, Mertens, Bekaert, Seidel & Kautz, *Convolution shadow maps*, 2007, eq. 6.
//! - `MATH.md` section 7; section 10 row 21.

use core::f32::consts::PI;

use glam::Vec4;

/// Twin of the shader's constant: depths are stored within this share of half the period.
pub const ANTUMBRA_CONVOLUTION_RANGE: f32 = 0.9;

/// Twin of `antumbra_convolution_frequency`: `c_k` of term k − 1.
#[must_use]
pub fn antumbra_convolution_frequency(term: u32) -> f32 {
    PI * (2 * term + 1) as f32
}

/// Twin of `antumbra_convolution_terms`: cosine and sine of a term and of the next one.
#[must_use]
pub fn antumbra_convolution_terms(depth: f32, term: u32) -> Vec4 {
    let at = depth * ANTUMBRA_CONVOLUTION_RANGE;
    let (first_sin, first_cos) = (antumbra_convolution_frequency(term) * at).sin_cos();
    let (second_sin, second_cos) = (antumbra_convolution_frequency(term + 1) * at).sin_cos();
    Vec4::new(first_cos, first_sin, second_cos, second_sin)
}

/// Twin of `antumbra_convolution_part`: what two terms add to s at a depth.
#[must_use]
pub fn antumbra_convolution_part(terms: Vec4, depth: f32, term: u32) -> f32 {
    let at = antumbra_convolution_terms(depth, term);
    let first = (at.x * terms.y - at.y * terms.x) / antumbra_convolution_frequency(term);
    let second = (at.z * terms.w - at.w * terms.z) / antumbra_convolution_frequency(term + 1);
    2.0 * (first + second)
}

/// Twin of `antumbra_convolution_lit`: (2), 0 to 1.
#[must_use]
pub fn antumbra_convolution_lit(sum: f32) -> f32 {
    if sum < 0.5 { (2.0 * sum).clamp(0.0, 1.0) } else { 1.0 }
}
