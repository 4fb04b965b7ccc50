//! What a warp is chosen from: the body as light and eye see it.
//!
//! # References
//! - Scherzer, *Robust shadow maps for large environments*, 2005, eq. (3): V_P, the view direction across the light.

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::light_space::LightSpace;
use crate::math::convex::MAX_VERTICES;
use crate::math::homography::WarpFrame;

/// A body in the plane across the light, with the eye depth of each of its points.
#[derive(Clone, Debug)]
pub(crate) struct Sight {
    /// The frame of the plane.
    pub(crate) light: LightSpace,
    /// (p, q) of the body's vertices.
    pub(crate) points: ArrayVec<DVec2, MAX_VERTICES>,
    /// Their eye depths, within the camera's range.
    pub(crate) depths: ArrayVec<f64, MAX_VERTICES>,
    /// (p, q) of the eye.
    pub(crate) eye: DVec2,
    /// The view direction in (p, q): its length is the sine of the angle between light and view.
    pub(crate) view: DVec2,
}

impl Sight {
    /// Of a body given by its vertices, in render space.
    pub(crate) fn of(camera: &Camera, travel: DVec3, vertices: &[DVec3], origin: DVec3) -> Self {
        let light = LightSpace::fixed(travel);
        let (near, far) = camera.projection.depth_range();
        let across = |vector: DVec3| light.ray(vector).truncate();
        Self {
            light,
            points: vertices.iter().take(MAX_VERTICES).map(|vertex| across(*vertex)).collect(),
            depths: vertices
                .iter()
                .take(MAX_VERTICES)
                .map(|vertex| camera.eye_depth(*vertex, origin).clamp(near, far))
                .collect(),
            eye: across(camera.eye() - origin),
            view: across(camera.forward()),
        }
    }

    /// The frame of a warp along the view: u from the body's nearest point across the light to its farthest.
    pub(crate) fn frame(&self) -> WarpFrame {
        WarpFrame::around(self.view, self.eye, &self.points)
    }

    /// Nearest and farthest eye depth of the body.
    pub(crate) fn depth_range(&self) -> (f64, f64) {
        self.depths
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), depth| (near.min(*depth), far.max(*depth)))
    }
}
