//! The predicted picture error of a warp, as a function of its strength, and the strength at which it is least.
//!
//! A shadow edge is displaced by about half a texel, so that the pixels it gets wrong are its length in the picture times the size of a
//! texel in pixels. The denser edges are in the world, the more of them a pixel holds: with depth their number in a pixel grows as their
//! displacement in pixels shrinks, and what is left is the size of a texel in the *world*, averaged over the picture. W is linear in
//! space, so that this mean needs two moments of what is seen:
//!
//! ```text
//! (1)  E(κ) = (a1 − a0) ⟨W⟩ + λ/k √(1 + κ² m) ⟨W²⟩,   W = 1 + κu,  k = 1 + κλ,  m = (a0² + a0 a1 + a1²)/3
//! (2)  ⟨f⟩ = (1 − τ) Σ rays ∫ f(u(ζ)) dζ + τ Σ samples f(u)
//! (3)  reluctance: E(κ) is made dearer by 0.15 κλ / (1 + κλ)
//! ```
//!
//! The first summand of (1) is the side of a texel across the axis, the second the one along it, which slants with the side lines. The
//! first sum of (2) takes shadow edges to be anywhere along every ray of the picture that the body allows; the second one takes them to be
//! where the engine says that surfaces are seen. An evaluation costs the side lines; the moments are taken once.
//!
//! Kind of promise: typical. Measured in `docs/WARPS.md`: over many scenes the strength of least E comes within a few per cent of the best one.
//!
//! # References
//! - `MATH.md` section 0 (the closed form), section 8 (texels in the picture).
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008: errors of warps by storage and by maximum,
//!   which this mean replaces.

use glam::{DVec2, DVec3};

use super::search::{least, not_worse};
use super::sight::Sight;
use crate::camera::Camera;
use crate::focus::FocusBody;
use crate::math::homography::WarpFrame;

/// Rays across and down the part of the picture that the body covers. Twice as many in each direction move the chosen strength by a
/// hundredth and cost microseconds; half as many make it jump where a ray leaves the body.
const RAYS: [u32; 2] = [8, 6];

/// Samples inside the body that weigh as much as the body does. Fewer trust single pixels; more ask for more samples than move the result.
/// Measured: a few hundred samples should decide nearly alone; the body remains for what they have not seen.
const ENOUGH_SAMPLES: f64 = 8.0;

/// What a strong warp costs beyond (1), as a share of the error: strengths that are too weak by half cost a few per cent, strengths too strong
/// by half cost twice that. Measured: 0.15 gives away nothing in the mean, and the pictures that come out worse than uniform are half as many.
const RELUCTANCE: f64 = 0.15;

/// The body's moments along a warp's axis, and what an evaluation of the error needs besides.
#[derive(Clone, Debug)]
pub(crate) struct Predictor<'a> {
    points: &'a [DVec2],
    frame: WarpFrame,
    /// Means of (u/λ)^i, i = 1, 2.
    moments: [f64; 2],
}

impl<'a> Predictor<'a> {
    /// Of what is in view, along the axis of `frame`; `samples` are positions that are seen, world space, any number of them.
    pub(crate) fn of(
        camera: &Camera,
        body: &FocusBody,
        sight: &'a Sight,
        frame: &WarpFrame,
        samples: &[DVec3],
        origin: DVec3,
    ) -> Self {
        let along = |vector: DVec3| sight.light.ray(vector).truncate().dot(frame.axis) / frame.extent;
        let top = frame.top.dot(frame.axis) / frame.extent;
        // Anywhere in the body.
        let mut sums = [0.0; 3];
        for (start, direction) in rays(camera, body, origin) {
            let Some([near, far]) = span(body, start, direction) else { continue };
            let (from, to) = (along(start + direction * near) - top, along(start + direction * far) - top);
            let length = far - near;
            sums[0] += length;
            sums[1] += length * 0.5 * (from + to);
            sums[2] += length * (from * from + from * to + to * to) / 3.0;
        }
        let in_body = [sums[1] / sums[0], sums[2] / sums[0]];
        // Where surfaces are seen.
        let mut seen = [0.0; 3];
        for sample in samples {
            let at = along(*sample - origin) - top;
            if (0.0..=1.0).contains(&at) {
                seen[0] += 1.0;
                seen[1] += at;
                seen[2] += at * at;
            }
        }
        let trust = seen[0] / (seen[0] + ENOUGH_SAMPLES);
        let in_picture = [seen[1], seen[2]].map(|sum| sum / seen[0].max(1.0));
        // A body that no ray meets is a sliver: nothing is known of it, and (1, 1) wants no warp.
        let moments = [0, 1].map(|i| {
            let anywhere = if in_body[i].is_finite() { in_body[i].clamp(0.0, 1.0) } else { 1.0 };
            anywhere + trust * (in_picture[i] - anywhere)
        });
        Self { points: &sight.points, frame: *frame, moments }
    }

    /// E at κλ = `strength`, world units: the sides of a texel, if one texel were all there is.
    pub(crate) fn error(&self, strength: f64) -> f64 {
        let extent = self.frame.extent;
        let kappa = strength / extent;
        let [first, second] = self.moments;
        let w = 1.0 + strength * first;
        let w_squared = 1.0 + strength * (2.0 * first + strength * second);
        let [a0, a1] = self.frame.sides(kappa, self.points);
        let slant = (1.0 + kappa * kappa * (a0 * a0 + a0 * a1 + a1 * a1) / 3.0).sqrt();
        let k = 1.0 + strength;
        ((a1 - a0) * w + extent / k * slant * w_squared) * (1.0 + RELUCTANCE * strength / k)
    }

    /// The strength of the least error, at most κλ = `limit`.
    pub(crate) fn least(&self, limit: f64) -> f64 {
        least(limit, |strength| self.error(strength))
    }

    /// A strength, limited to what is predicted to be no worse than `uniform`, the error without a warp.
    pub(crate) fn guarded(&self, strength: f64, uniform: f64) -> f64 {
        not_worse(strength, uniform, |strength| self.error(strength))
    }
}

/// E without a warp: it does not depend on the axis that a method would have bent along, so that all methods are measured by one.
pub(crate) fn uniform_error(sight: &Sight) -> f64 {
    let frame = sight.frame();
    let [a0, a1] = frame.sides(0.0, &sight.points);
    a1 - a0 + frame.extent
}

/// Rays over the part of the picture that the body covers: positions at eye depth ζ are start + direction · ζ.
fn rays<'a>(camera: &'a Camera, body: &FocusBody, origin: DVec3) -> impl Iterator<Item = (DVec3, DVec3)> + use<'a> {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for vertex in &body.vertices {
        let at = camera.picture_position(*vertex, origin);
        low = low.min(at);
        high = high.max(at);
    }
    let [columns, rows] = RAYS;
    (0..columns * rows).map(move |index| {
        let cell = DVec2::new(f64::from(index % columns) + 0.5, f64::from(index / columns) + 0.5);
        let at = low + (high - low) * cell / DVec2::new(f64::from(columns), f64::from(rows));
        camera.ray(at, origin)
    })
}

/// The eye depths between which a ray is inside the body.
fn span(body: &FocusBody, start: DVec3, direction: DVec3) -> Option<[f64; 2]> {
    let (mut near, mut far) = (body.depth.near, body.depth.far);
    for wall in &body.walls {
        let (at_start, per_depth) = (wall.truncate().dot(start) + wall.w, wall.truncate().dot(direction));
        let crossing = -at_start / per_depth;
        if per_depth > 0.0 {
            near = near.max(crossing);
        } else if per_depth < 0.0 {
            far = far.min(crossing);
        } else if at_start < 0.0 {
            return None;
        }
    }
    (near < far).then_some([near, far])
}
