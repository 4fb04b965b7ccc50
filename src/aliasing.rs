//! The footprint of a texel in the picture.
//!
//! # References
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008: error m = texel over pixel.
//! - `MATH.md` section 8.

use glam::DVec3;

use crate::camera::Camera;
use crate::frame::Footprint;

/// Pixels per texel of a map over a body, and the range of eye depths: texel size over pixel size at its vertices.
/// `texel` gives the longest side of a texel at a vertex, world units.
///
/// Exact for surfaces that face both the light and the camera. O(vertices).
pub(crate) fn footprint(
    camera: &Camera,
    vertices: &[DVec3],
    origin: DVec3,
    texel: impl Fn(&DVec3) -> f64,
) -> (Footprint, [f32; 2]) {
    let (near, far) = camera.projection.depth_range();
    let picture = camera.viewport.as_dvec2();
    // A lens that sees nothing wide makes texels that fill any picture: the largest number stands for it.
    let largest = f64::from(f32::MAX);
    let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for vertex in vertices {
        let depth = camera.eye_depth(*vertex, origin).clamp(near, far);
        nearest = nearest.min(depth);
        farthest = farthest.max(depth);
        let pixels = (texel(vertex) * (picture / camera.projection.size_at(depth)).max_element()).min(largest);
        least = least.min(pixels);
        most = most.max(pixels);
    }
    (Footprint { min: least.min(largest) as f32, max: most as f32, error: 0.0 }, [nearest as f32, farthest as f32])
}
