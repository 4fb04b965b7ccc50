//! The footprint of a texel in the picture.
//!
//! # References
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008: error m = texel over pixel.
//! - `MATH.md` section 8.

use glam::DVec3;

use crate::camera::Camera;
use crate::frame::Footprint;

/// What a body's vertices say of a map's texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extremes {
    /// Pixels per texel: its longest side over a pixel at the eye depth.
    pub(crate) pixels: Footprint,
    /// Shortest and longest side of a texel, world units.
    pub(crate) world: [f32; 2],
    /// Nearest and farthest eye depth.
    pub(crate) domain: [f32; 2],
}

/// The extremes over the vertices of a body; `sides` gives the sides of a texel at a vertex, world units across the light.
///
/// Exact for surfaces that face both the light and the camera. O(vertices).
pub(crate) fn extremes(
    camera: &Camera,
    vertices: &[DVec3],
    origin: DVec3,
    sides: impl Fn(DVec3) -> [f64; 2],
) -> Extremes {
    let (near, far) = camera.projection.depth_range();
    let pixels_per_unit = camera.pixels_per_unit();
    let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for vertex in vertices {
        let depth = camera.eye_depth(*vertex, origin).clamp(near, far);
        let [one, other] = sides(*vertex);
        let (short, long) = (one.min(other), one.max(other));
        let pixels = long * pixels_per_unit / if camera.projection.spreads() { depth } else { 1.0 };
        (nearest, farthest) = (nearest.min(depth), farthest.max(depth));
        (shortest, longest) = (shortest.min(short), longest.max(long));
        (least, most) = (least.min(pixels), most.max(pixels));
    }
    Extremes {
        pixels: Footprint { min: narrowed(least), max: narrowed(most), error: 0.0 },
        world: [narrowed(shortest), narrowed(longest)],
        domain: [nearest as f32, farthest as f32],
    }
}

/// To f32. A lens that sees nothing wide makes texels that fill any picture: the largest number stands for it.
fn narrowed(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}
