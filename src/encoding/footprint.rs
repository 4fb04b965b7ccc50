//! The debug view of aliasing: the Rust twin of `shaders/footprint.wgsl` ([`wgsl::FOOTPRINT`](crate::wgsl::FOOTPRINT)).
//!
//! Each function has the name and the arithmetic of its shader twin, in f32; `tests/footprint` holds them together
//! on an adapter. [`aliasing::footprint_at`](crate::aliasing::footprint_at) is the exact one,
//! from a normal instead of derivatives.
//!
//! # References
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008:
//!   error m = texel over pixel.
//! - `MATH.md` section 8.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::frame::ViewUniforms;

/// Twin of the shader's constant: below every extent in texels that matters.
const ANTUMBRA_FOOTPRINT_SMALLEST: f32 = 1e-30;

/// Twin of the shader's constant: factors of two from 1 texel per pixel to the ends of the scale of colours. Fewer
/// would saturate on the first small map, more would make pictures pale.
pub const ANTUMBRA_FOOTPRINT_OCTAVES: f32 = 4.0;

/// Twin of `antumbra_footprint`: texels over a pixel in the direction in which there are fewest,
/// 0 where there is no map.
///
/// `side` is that of the map, texels; the derivatives are the receiver's steps from a pixel to the next, to the right
/// and downwards or upwards, world units.
#[must_use]
pub fn antumbra_footprint(
    view: &ViewUniforms,
    side: f32,
    position: Vec3,
    d_position_dx: Vec3,
    d_position_dy: Vec3,
) -> f32 {
    let [u, v, w, rect] = [view.u_from_render, view.v_from_render, view.w_from_render, view.rect].map(Vec4::from_array);
    let at = position.extend(1.0);
    let at_w = w.dot(at);
    let from_w = if at_w > 0.0 { 1.0 / at_w } else { 0.0 };
    let uv = Vec2::new(u.dot(at), v.dot(at)) * from_w;
    let [u, v] = [u.xyz() - uv.x * w.xyz(), v.xyz() - uv.y * w.xyz()].map(|row| row * (side * from_w));
    let along_x = Vec2::new(u.dot(d_position_dx), v.dot(d_position_dx));
    let along_y = Vec2::new(u.dot(d_position_dy), v.dot(d_position_dy));
    let turned = Vec2::new(along_y.y, -along_y.x);
    let longest = 0.5 * ((along_x + turned).length() + (along_x - turned).length());
    let shortest = along_x.dot(turned / longest.max(ANTUMBRA_FOOTPRINT_SMALLEST)).abs();
    let inside = at_w > 0.0 && uv.cmpge(rect.xy()).all() && uv.cmple(rect.zw()).all();
    if inside { shortest } else { 0.0 }
}

/// Twin of `antumbra_footprint_colour`: sRGB, each channel 0 to 1. White at 1 texel per pixel, red for fewer, blue for
/// more, grey for 0.
#[must_use]
pub fn antumbra_footprint_colour(texels_per_pixel: f32) -> Vec3 {
    let place = texels_per_pixel.max(ANTUMBRA_FOOTPRINT_SMALLEST).log2() / ANTUMBRA_FOOTPRINT_OCTAVES;
    let off = place.abs().min(1.0);
    let (middle, end) = if place < 0.0 {
        (Vec3::new(0.96, 0.65, 0.48), Vec3::new(0.64, 0.05, 0.15))
    } else {
        (Vec3::new(0.40, 0.66, 0.81), Vec3::new(0.08, 0.30, 0.56))
    };
    let pale = Vec3::splat(0.97).lerp(middle, (2.0 * off).min(1.0));
    if texels_per_pixel > 0.0 { pale.lerp(end, (2.0 * off - 1.0).max(0.0)) } else { Vec3::splat(0.35) }
}
