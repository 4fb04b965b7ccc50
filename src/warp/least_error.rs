//! The predicted picture error of a warp, as a function of its strength, and the strength at which it is least.
//!
//! A shadow edge is displaced by about half a texel, so that the pixels it gets wrong are its length in the picture
//! times the size of a texel in pixels. The denser edges are in the world, the more of them a pixel holds: with depth
//! their number in a pixel grows as their displacement in pixels shrinks, and what is left is the size of a texel in
//! the *world*, averaged over the picture. W is linear in space, so that this mean needs two moments of what is seen:
//!
//! ```text
//! (1)  E(κ) = (a1 − a0) ⟨W⟩ + λ/k √(1 + κ² m) ⟨W²⟩,   W = 1 + κu,  k = 1 + κλ,  m = (a0² + a0 a1 + a1²)/3
//! (2)  ⟨f⟩ = (1 − τ) Σ rays ∫ f(u(ζ)) dζ + τ Σ samples f(u)
//! (3)  reluctance: E(κ) is made dearer by 0.2 κλ / (1 + κλ)
//! ```
//!
//! The first summand of (1) is the side of a texel across the axis, the second the one along it, which slants with the
//! side lines. The first sum of (2) takes shadow edges to be anywhere along every ray of the picture that the body
//! allows; the second one takes them to be where the engine says that surfaces are seen. An evaluation costs the side
//! lines; the moments are taken once.
//!
//! Kind of promise: typical. `docs/WARPS.md` has the strength of least E beside the best one of a sweep, on many
//! scenes: mostly within a tenth of its error, and what the exceptions are.
//!
//! # References
//! - `MATH.md` section 0 (the closed form), section 8 (texels in the picture).
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008: errors of warps by
//!   storage and by maximum, which this mean replaces.

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3};

use super::search::{least, not_worse};
use super::sheaf::Sheaf;
use super::sight::Sight;
use crate::camera::Camera;
use crate::focus::FocusBody;
use crate::math::convex::MAX_VERTICES;
use crate::math::homography::WarpFrame;

/// Samples inside the body that weigh as much as the body does. Fewer trust single pixels; more ask for more samples
/// than move the result. Measured: a few hundred samples should decide nearly alone; the body remains for what they
/// have not seen.
const ENOUGH_SAMPLES: f64 = 8.0;

/// What a strong warp costs beyond (1), as a share of the error: strengths that are too weak by half cost a few per
/// cent, strengths too strong by half cost twice that. Measured: 0.2 gives away nothing in the mean, and the pictures
/// that come out worse than uniform are half as many.
const RELUCTANCE: f64 = 0.2;

/// Points whose side lines are looked at together: processors divide two or four numbers at a time.
const LANES: usize = 2;

/// Groups of as many points.
const GROUPS: usize = MAX_VERTICES.div_ceil(LANES);

/// What is seen, across the light: means and mean products of (p, q), relative to the eye.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    mean: DVec2,
    /// Means of p², p q, q².
    products: DVec3,
}

impl Seen {
    /// Of a body in view; `samples` are positions that are seen, world space, any number of them.
    pub(crate) fn of(camera: &Camera, body: &FocusBody, sight: &Sight, samples: &[DVec3], origin: DVec3) -> Self {
        let across = |vector: DVec3| sight.light.ray(vector).truncate() - sight.eye;
        // Anywhere in the body: (2), along rays.
        let (mut length, mut sum, mut products) = (0.0, DVec2::ZERO, DVec3::ZERO);
        let sheaf = Sheaf::through(body, camera, origin);
        for ([from, to], span) in sheaf.spans(|vector| sight.light.ray(vector).truncate()) {
            length += span;
            sum += (from + to) * (0.5 * span);
            products += mean_products(from, to) * span;
        }
        let anywhere = Self { mean: sum / length, products: products / length };
        // Where surfaces are seen.
        let (mut count, mut sum, mut products) = (0.0, DVec2::ZERO, DVec3::ZERO);
        let [low, high] = if samples.is_empty() { [DVec2::ZERO; 2] } else { sight.bounds() };
        for sample in samples {
            let at = across(*sample - origin);
            let depth = camera.eye_depth(*sample, DVec3::ZERO);
            let deep = body.depth.near <= depth && depth <= body.depth.far;
            if deep && at.cmpge(low).all() && at.cmple(high).all() {
                count += 1.0;
                sum += at;
                products += mean_products(at, at);
            }
        }
        if count == 0.0 {
            return anywhere;
        }
        let in_picture = Self { mean: sum / count, products: products / count };
        if !(length > 0.0) {
            return in_picture;
        }
        let trust = count / (count + ENOUGH_SAMPLES);
        Self {
            mean: anywhere.mean.lerp(in_picture.mean, trust),
            products: anywhere.products.lerp(in_picture.products, trust),
        }
    }

    /// The direction in which W has to grow to be small where things are seen: from their mean to the middle of the
    /// body. Not normalised; it vanishes where no direction is better than another, and there a warp along it does no
    /// good.
    pub(crate) fn axis(&self, sight: &Sight) -> DVec2 {
        sight.middle() - (self.mean + sight.eye)
    }
}

/// Means of p², p q, q² between two points.
fn mean_products(from: DVec2, to: DVec2) -> DVec3 {
    let mean = |a: f64, b: f64, c: f64, d: f64| (2.0 * (a * c + b * d) + a * d + b * c) / 6.0;
    DVec3::new(mean(from.x, to.x, from.x, to.x), mean(from.x, to.x, from.y, to.y), mean(from.y, to.y, from.y, to.y))
}

/// The moments of what is seen along a warp's axis, and what an evaluation of the error needs besides.
#[derive(Clone, Debug)]
pub(crate) struct Predictor {
    /// u and c of the body's vertices, [`LANES`] at a time; the last ones repeat one.
    points: ArrayVec<[[f64; LANES]; 2], GROUPS>,
    /// λ.
    extent: f64,
    /// Means of (u/λ)^i, i = 1, 2.
    moments: [f64; 2],
}

impl Predictor {
    /// Along the axis of `frame`.
    pub(crate) fn along(frame: &WarpFrame, seen: &Seen, sight: &Sight) -> Self {
        let points = sight.points.chunks(LANES).map(|group| {
            let at = |lane: usize| frame.coordinates(group[lane.min(group.len() - 1)]);
            // Points before the top line are there by rounding.
            [core::array::from_fn(|lane| at(lane).x.max(0.0)), core::array::from_fn(|lane| at(lane).y)]
        });
        let points = points.collect();
        // u = axis · (x − eye) + shift.
        let (axis, shift) = (frame.axis, frame.axis.dot(sight.eye - frame.top));
        let mean = axis.dot(seen.mean);
        let squares = DVec3::new(axis.x * axis.x, 2.0 * axis.x * axis.y, axis.y * axis.y).dot(seen.products);
        let first = (mean + shift) / frame.extent;
        let second = (squares + shift * (2.0 * mean + shift)) / (frame.extent * frame.extent);
        // Nothing is seen (a sliver between rays): what wants no warp.
        let share = |moment: f64| if moment.is_finite() { moment.clamp(0.0, 1.0) } else { 1.0 };
        Self { points, extent: frame.extent, moments: [share(first), share(second)] }
    }

    /// E at κλ = `strength`, world units: the sides of a texel, if one texel were all there is.
    pub(crate) fn error(&self, strength: f64) -> f64 {
        let kappa = strength / self.extent;
        let [first, second] = self.moments;
        let w = 1.0 + strength * first;
        let w_squared = 1.0 + strength * (2.0 * first + strength * second);
        let [a0, a1] = self.sides(kappa);
        let slant = (1.0 + kappa * kappa * (a0 * a0 + a0 * a1 + a1 * a1) / 3.0).sqrt();
        let k = 1.0 + strength;
        ((a1 - a0) * w + self.extent / k * slant * w_squared) * (1.0 + RELUCTANCE * strength / k)
    }

    /// Side lines: the least and greatest c/W.
    fn sides(&self, kappa: f64) -> [f64; 2] {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for [along, across] in &self.points {
            let slopes: [f64; LANES] = core::array::from_fn(|lane| across[lane] / (1.0 + kappa * along[lane]));
            for slope in slopes {
                low = if slope < low { slope } else { low };
                high = if slope > high { slope } else { high };
            }
        }
        [low, high]
    }

    /// The strength of the least error, at most κλ = `limit`.
    pub(crate) fn least(&self, limit: f64) -> f64 {
        least(limit, |strength| self.error(strength))
    }

    /// A strength, limited to what is predicted to be no worse than `uniform`, the error without a warp.
    pub(crate) fn guarded(&self, strength: f64) -> f64 {
        not_worse(strength, |strength| self.error(strength))
    }
}

/// E without a warp, by the view's axis: the scale on which all methods are measured, whatever axis they bend along.
pub(crate) fn uniform_error(sight: &Sight) -> f64 {
    let frame = sight.frame;
    let [a0, a1] = frame.sides(0.0, &sight.points);
    a1 - a0 + frame.extent
}
