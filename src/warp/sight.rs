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
    /// Width or height of a pixel, whichever is less, world units: a constant, and what a unit of eye depth adds.
    pub(crate) pixel: [f64; 2],
    /// The view direction in (p, q): its length is the sine of the angle between light and view.
    pub(crate) view: DVec2,
    /// The frame of a warp along the view: u from the body's nearest point across the light to its farthest. The centre
    /// line passes through the eye, as in the papers.
    pub(crate) frame: WarpFrame,
    /// Sine of the angle from the view axis to the picture's widest side, at least [`LEAST_SINE`].
    pub(crate) half_angle_sine: f64,
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
        let per_depth = camera.pixels_per_unit().recip();
        let eye = across(camera.eye() - origin);
        let points: ArrayVec<DVec2, MAX_VERTICES> = vertices().map(|vertex| across(*vertex)).collect();
        let view = across(camera.forward());
        Self {
            light,
            frame: WarpFrame::around(view, eye, &points),
            points,
            pixel: if camera.projection.spreads() { [0.0, per_depth] } else { [per_depth, 0.0] },
            depths,
            eye,
            view,
            half_angle_sine: camera.projection.half_angle_sine().max(LEAST_SINE),
            right: across(camera.world_from_view.x_axis.truncate()),
            up: across(camera.world_from_view.y_axis.truncate()),
        }
    }

    /// The frame of a warp along any direction, its centre line through the middle of the body.
    pub(crate) fn frame_along(&self, axis: DVec2) -> WarpFrame {
        WarpFrame::around(axis, self.middle(), &self.points)
    }

    /// A point in the middle of the hull of the points that moves continuously with them.
    pub(crate) fn middle(&self) -> DVec2 {
        middle(&self.points, self.eye)
    }

    /// Least and greatest of the points, relative to the eye.
    pub(crate) fn bounds(&self) -> [DVec2; 2] {
        let empty = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let grown = |[low, high]: [DVec2; 2], at: DVec2| [low.min(at), high.max(at)];
        self.points.iter().fold(empty, |bounds, point| grown(bounds, *point - self.eye))
    }

    /// How well the view has a direction across the light, 0 (view along the light) to 1 (the light is outside of the
    /// picture): smooth, so that a warp along it is gone before its axis spins.
    pub(crate) fn directed(&self) -> f64 {
        let share = (self.view.length() / self.half_angle_sine).min(1.0);
        share * share * (3.0 - 2.0 * share)
    }

    /// Nearest and farthest eye depth of the body.
    pub(crate) fn depth_range(&self) -> (f64, f64) {
        self.depths
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), depth| (near.min(*depth), far.max(*depth)))
    }
}

/// Views within this sine of the light have no direction whatever the lens: telephoto and orthographic cameras too need
/// room in which to fade. Smaller lets axes spin within a frame; larger gives up warps that would serve.
const LEAST_SINE: f64 = 0.05;

/// Directions in which [`middle`] looks. With 4 it would be the middle of a box; more follow the hull's shape, and cost
/// time.
const DIRECTIONS: u32 = 12;

/// The Steiner point of the hull of some points: the mean of its extreme points over all directions, here over a dozen.
///
/// Continuous, unlike the mean of the vertices, and inside the hull. `near` is where numbers are small.
fn middle(points: &[DVec2], near: DVec2) -> DVec2 {
    let step = DVec2::from_angle(core::f64::consts::TAU / f64::from(DIRECTIONS));
    let mut direction = DVec2::X;
    let mut sum = DVec2::ZERO;
    for _ in 0..DIRECTIONS {
        let support = points.iter().map(|point| direction.dot(*point - near)).fold(f64::NEG_INFINITY, f64::max);
        sum += direction * support;
        direction = step.rotate(direction);
    }
    near + sum * (2.0 / f64::from(DIRECTIONS))
}
