//! How the taps of a disc are spread around a receiver: the Rust twin of `shaders/spread_*.wgsl`.
//!
//! A light of angular diameter α throws penumbras whose radius, across the light, is tan(α/2) times the distance
//! between caster and receiver: a disc in the world. Texels are not: a map may be longer than wide, and warped. So the
//! disc is spanned by two radii across the light, each as texels, by the derivative of texture coordinates at the
//! receiver:
//!
//! ```text
//! ∇u = (U − u W) / w,   ∇v = (V − v W) / w       (rows of the view; none of them changes along the light)
//! ```
//!
//! Taps are where this derivative says, not where the world's disc lies exactly; 1/w falls linearly on the way there
//! (bias.rs, equation 1), which is what linear depth is recovered with.
//!
//! # References
//! - Fernando, *Percentage-closer soft shadows*, 2005: penumbras as wide as casters are far.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::pixel::{Pixel, antumbra_spread_pixel};
use crate::frame::{MapShape, Pcf, ViewUniforms, WgslKey};

/// How taps are spread around a receiver. Twin of `AntumbraSpread`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// By how much of a whole turn the disc is turned.
    pub noise: f32,
    /// Linear light depth of the receiver.
    pub depth: f32,
    /// w at the receiver.
    pub w: f32,
    /// Texels along a radius of the penumbra, for each unit of linear light depth between caster and receiver.
    pub along: Vec2,
    /// The same along the radius at a right angle to it, in the world.
    pub across: Vec2,
    /// By how much of itself one over w falls along them.
    pub fade: Vec2,
    /// Least distance between caster and receiver whose penumbra the map shows as wide as it is, linear light depth.
    pub least: f32,
    /// Greatest such distance.
    pub most: f32,
    /// The pixel's own part of the map, for filters that follow it.
    pub pixel: Pixel,
    /// How a lookup's texture coordinates and depth go back for each texel that a disc is narrower than the widest one.
    pub back: Vec3,
    /// What depths are multiplied by; the shader's text knows it.
    pub shape: MapShape,
}

/// Twin of the shader's constant: below every length that is divided by.
pub(crate) const ANTUMBRA_SPREAD_SMALLEST: f32 = 1e-30;

/// Twin of the shader's constant: below every w in view.
pub(crate) const ANTUMBRA_SPREAD_LEAST_W: f32 = 1e-6;

/// Twin of the shader's constant: radius of the narrowest disc, texels.
pub(crate) const ANTUMBRA_NARROWEST: f32 = 0.5;

/// Twin of `antumbra_spread`: how the taps of a key's filter are spread.
#[must_use]
pub fn antumbra_spread(key: WgslKey, view: &ViewUniforms, position: Vec3, normal: Vec3, noise: f32) -> Spread {
    if key.filter == Pcf::Pixel {
        return antumbra_spread_pixel(key.shape, view, position, normal);
    }
    if key.filter != Pcf::Pcss {
        return Spread { noise, shape: key.shape, ..Spread::default() };
    }
    let [u_row, v_row, w_row, depth] =
        [view.u_from_render, view.v_from_render, view.w_from_render, view.depth_from_render].map(Vec4::from_array);
    let at = position.extend(1.0);
    let w = w_row.dot(at).max(ANTUMBRA_SPREAD_LEAST_W);
    let uv = Vec2::new(u_row.dot(at), v_row.dot(at)) / w;
    let along_u = (u_row.xyz() - uv.x * w_row.xyz()) / w;
    let along_v = (v_row.xyz() - uv.y * w_row.xyz()) / w;
    let travel = depth.xyz() / depth.xyz().length().max(ANTUMBRA_SPREAD_SMALLEST);
    let first = along_u / along_u.length().max(ANTUMBRA_SPREAD_SMALLEST);
    let second = travel.cross(first);
    let texels = view.moments[0] / view.bias[3].max(ANTUMBRA_SPREAD_SMALLEST);
    let along = Vec2::new(along_u.dot(first), along_v.dot(first)) * texels;
    let across = Vec2::new(0.0, along_v.dot(second)) * texels;
    let wide = along.x.abs().max(Vec2::new(along.y, across.y).length());
    Spread {
        noise,
        depth: depth.dot(at),
        w,
        along,
        across,
        fade: Vec2::new(w_row.xyz().dot(first), w_row.xyz().dot(second)) * (view.moments[0] / w),
        pixel: Pixel::default(),
        least: ANTUMBRA_NARROWEST / wide.max(ANTUMBRA_SPREAD_SMALLEST),
        most: view.moments[1].max(ANTUMBRA_NARROWEST) / wide.max(ANTUMBRA_SPREAD_SMALLEST),
        back: Vec3::ZERO,
        shape: key.shape,
    }
}
