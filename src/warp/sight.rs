//! What a warp is chosen from: the body as light and eye see it.
//!
//! # References
//! - Scherzer, *Robust shadow maps for large environments*, 2005, eq. (3): `V_P`, the view direction across the light.

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::light_space::LightSpace;
use crate::math::convex::MAX_VERTICES;
use crate::math::homography::WarpFrame;

/// The warp that a method chose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// Axis, top line and extent.
    pub(crate) frame: WarpFrame,
    /// κλ, 0 to ∞.
    pub(crate) strength: f64,
}

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
    /// Width or height of a pixel at each of them, whichever is less, world units.
    pub(crate) pixel_sizes: ArrayVec<f64, MAX_VERTICES>,
    /// The view direction in (p, q): its length is the sine of the angle between light and view.
    pub(crate) view: DVec2,
    /// The picture's axes to the right and up in (p, q).
    pub(crate) right: DVec2,
    pub(crate) up: DVec2,
}

impl Sight {
    /// Of a body given by its vertices, in render space.
    pub(crate) fn of(camera: &Camera, travel: DVec3, vertices: &[DVec3], origin: DVec3) -> Self {
        let light = LightSpace::fixed(travel);
        let (near, far) = camera.projection.depth_range();
        let across = |vector: DVec3| light.ray(vector).truncate();
        let vertices = || vertices.iter().take(MAX_VERTICES);
        let depths: ArrayVec<f64, MAX_VERTICES> =
            vertices().map(|vertex| camera.eye_depth(*vertex, origin).clamp(near, far)).collect();
        let picture = camera.viewport.as_dvec2();
        let pixel_size = |depth: &f64| (camera.projection.size_at(*depth) / picture).min_element();
        Self {
            light,
            points: vertices().map(|vertex| across(*vertex)).collect(),
            pixel_sizes: depths.iter().map(pixel_size).collect(),
            depths,
            eye: across(camera.eye() - origin),
            view: across(camera.forward()),
            right: across(camera.world_from_view.x_axis.truncate()),
            up: across(camera.world_from_view.y_axis.truncate()),
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
