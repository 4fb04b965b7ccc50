//! How wide slices of a body are, as the light sees them: what decides the size of their texels.
//!
//! # References
//! - Lloyd, Tuft, Yoon & Manocha, *Warping and partitioning for low error shadow maps*, 2006: texels by what a map has
//!   to cover.

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3, Vec3Swizzles};

use crate::camera::Camera;
use crate::focus::FocusBody;
use crate::light_space::LightSpace;
use crate::math::convex::MAX_EDGES;

/// The edges of a body, each as eye depth, place along the view and place across it, of both ends, the nearer one
/// first.
pub(crate) struct Profile {
    edges: ArrayVec<[DVec3; 2], MAX_EDGES>,
}

impl Profile {
    /// Of a body in view. O(edges).
    pub(crate) fn of(body: &FocusBody, camera: &Camera, travel: DVec3, origin: DVec3) -> Self {
        // One side of every window along the view.
        let light = LightSpace::fixed(travel);
        let view = light.ray(camera.forward()).truncate();
        let light = light.turned(view.try_normalize().unwrap_or(DVec2::X));
        let place = |vertex: DVec3| light.ray(vertex).truncate().extend(camera.eye_depth(vertex, origin)).zxy();
        let ordered = |[a, b]: [DVec3; 2]| if a.x <= b.x { [a, b] } else { [b, a] };
        Self { edges: body.edges().map(|ends| ordered(ends.map(place))).collect() }
    }

    /// Width and height across the light, together, of the slice between two eye depths; 0 where there is nothing.
    /// O(edges).
    pub(crate) fn size(&self, near: f64, far: f64) -> f64 {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for &[first, last] in &self.edges {
            if first.x > far || last.x < near {
                continue;
            }
            let length = last.x - first.x;
            let at =
                |depth: f64| if length > 0.0 { first + (last - first) * ((depth - first.x) / length) } else { first };
            for end in [at(near.max(first.x)), at(far.min(last.x))] {
                low = low.min(end);
                high = high.max(end);
            }
        }
        let size = (high - low).max(DVec3::ZERO);
        size.y + size.z
    }
}
