//! How a map of moments is averaged before it is read: the Rust twins of `shaders/blur.wgsl`, `mean.wgsl` and
//! `mean_exponential.wgsl`.
//!
//! A box is averaged along u, then along v; its half-width is so many texels, or so many world units: then it is wider
//! in texels where texels of a warped map are smaller. With `t_u` and `t_v` the world steps from texel to texel,
//!
//! ```text
//! (1)  r_u = R / |t_u|,  r_v = R / |t_v|,   t_u = w² (V − v W),  t_v = w² (u W − U),   1/w linear in (u, v)
//! (2)  weight of a texel at offset o: box: its overlap with [−r, r]
//!      bell: e^(−3 o²/2r²), of the same deviation r/√3, times its overlap with [−1.44 r, 1.44 r]
//! ```
//!
//! # References
//! - Lauritzen, *Summed-area variance shadow maps*, GPU Gems 3, 2007 (separable filters of moments).

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::exponential::{antumbra_exponential_mean, antumbra_exponential_part};
use crate::texel::BlurUniforms;

/// Twin of the shader's constant: most texels of a half-width.
pub const ANTUMBRA_BLUR_MOST: f32 = 32.0;

/// Twin of the shader's constant: below every step between texels.
const ANTUMBRA_BLUR_SMALLEST: f32 = 1e-30;

/// Twin of the shader's constant: half-widths at which a bell is cut off.
const ANTUMBRA_BLUR_BELL_REACH: f32 = 1.44;

/// Twin of `antumbra_blur_radius`: half-width in texels of u and v, at a texel of the tile. Towards the rim, beyond
/// which nothing is drawn, it narrows.
#[must_use]
pub fn antumbra_blur_radius(blur: &BlurUniforms, texel: Vec2) -> Vec2 {
    let [across_u, across_v, across_w, inverse_w] =
        [blur.across_u, blur.across_v, blur.across_w, blur.inverse_w].map(|row| Vec4::from_array(row).xyz());
    let [x, y, side, of] = blur.tile;
    let uv = (Vec2::new(x as f32, y as f32) + texel + 0.5) / of as f32;
    let inverse_w = inverse_w.dot(Vec3::new(uv.x, uv.y, 1.0)).max(ANTUMBRA_BLUR_SMALLEST);
    let step_u = across_v - uv.y * across_w;
    let step_v = uv.x * across_w - across_u;
    let steps = Vec2::new(step_u.length(), step_v.length()).max(Vec2::splat(ANTUMBRA_BLUR_SMALLEST));
    let texels = blur.radius * inverse_w * inverse_w / steps;
    let room = texel.min(side as f32 - 1.0 - texel) - 1.0;
    let most = room / if blur.bell == 0 { 1.0 } else { ANTUMBRA_BLUR_BELL_REACH };
    let radius = if blur.radius >= 0.0 { texels } else { Vec2::splat(-blur.radius) };
    radius.min(most.clamp(Vec2::ZERO, Vec2::splat(ANTUMBRA_BLUR_MOST)))
}

/// Twin of `antumbra_blur_reach`: how many texels to either side weigh anything.
#[must_use]
pub fn antumbra_blur_reach(radius: f32, bell: bool) -> i32 {
    (if bell { radius * ANTUMBRA_BLUR_BELL_REACH } else { radius } - 0.5).ceil() as i32
}

/// Twin of `antumbra_blur_weight`: weight of a texel at an offset.
#[must_use]
pub fn antumbra_blur_weight(offset: f32, radius: f32, bell: bool) -> f32 {
    let share = offset / radius.max(0.5);
    let (height, end) =
        if bell { ((-1.5 * share * share).exp(), radius * ANTUMBRA_BLUR_BELL_REACH) } else { (1.0, radius) };
    height * (end + 0.5 - offset.abs()).clamp(0.0, 1.0)
}

/// A weighted mean in the making: twin of `AntumbraMean`, both of plain numbers and of exponentials.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mean {
    sum: Vec4,
    whole: f32,
}

/// Twin of the shader's constant: below every sum of weights.
const ANTUMBRA_MEAN_SMALLEST: f32 = 1e-30;

impl Mean {
    /// Twin of `antumbra_mean_with`; with an `exponent`, the one of exponentials.
    #[must_use]
    pub fn with(self, value: Vec4, weight: f32, exponent: Option<f32>) -> Self {
        let whole = self.whole + weight;
        let Some(exponent) = exponent else { return Self { sum: self.sum + value * weight, whole } };
        let farthest = if self.whole == 0.0 { value.x } else { self.sum.y.max(value.x) };
        let before = self.sum.x * antumbra_exponential_part(self.sum.y, farthest, exponent);
        let part = weight * antumbra_exponential_part(value.x, farthest, exponent);
        Self { sum: Vec4::new(before + part, farthest, 0.0, 0.0), whole }
    }

    /// Twin of `antumbra_mean`.
    #[must_use]
    pub fn value(self, exponent: Option<f32>) -> Vec4 {
        let Some(exponent) = exponent else { return self.sum / self.whole.max(ANTUMBRA_MEAN_SMALLEST) };
        let sum = self.sum.x / self.whole.max(ANTUMBRA_MEAN_SMALLEST);
        Vec4::X * antumbra_exponential_mean(sum, self.sum.y, exponent)
    }
}
