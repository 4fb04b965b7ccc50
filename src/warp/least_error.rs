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
//! Maps that are found by containment ([`Select::Finest`](crate::Select::Finest)) are looked up for more than their own
//! slice: for receivers behind it that they and no map before them hold, and not for those of the slice that such a map
//! holds. Their strength is the least one for the slice, weakened or strengthened until it is no more than 5 % worse,
//! by (1), than the best for the samples that they serve. Without that, planes that are 3 % nearer can let a map be
//! warped 14 times as strongly and wrong pixels of a picture rise from 1.0 to 2.4 % (SparseCity, across, 1024²,
//! points); with it they stay at 1.0 %. Taking the samples that are served for those of the slice mends that as well
//! and shows 2 % fewer wrong pixels on the built-in scenes, but 1 to 2 % more on the case files (one with 19 %); half
//! of both, 1 to 2 % more. Over all pictures of `docs/SPLITS.md` the limit changes the mean by less than 0.3 %.
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

use super::sheaf::Sheaf;
use super::sight::Sight;
use crate::camera::Camera;
use crate::focus::FocusBody;
use crate::math::convex::MAX_VERTICES;
use crate::math::homography::WarpFrame;
use crate::math::search::{crossing, least, not_worse, roughly_least};
use crate::scene::ENOUGH_SAMPLES;

/// What a strong warp costs beyond (1), as a share of the error: strengths that are too weak by half cost a few per
/// cent, strengths too strong by half cost twice that. Measured: 0.2 gives away nothing in the mean, and the pictures
/// that come out worse than uniform are half as many.
const RELUCTANCE: f64 = 0.2;

/// By which share a strength may be worse, for all that a map is looked up for, than the best for that. At 0 receivers
/// behind a slice decide as much as its own, and pictures of the case files come out 1 to 2 % worse; at 0.15 a map
/// whose warp is far too strong for what it serves keeps a third of the wrong pixels that this costs.
const SPARED: f64 = 0.05;

/// How near to that limit strengths are found, as a share of the error. More shows as steps when the camera moves.
const SPARED_CLOSE: f64 = 1e-6;

/// Most samples that are asked whether maps hold them. More move strengths by less than they cost time.
const MOST_ASKED: usize = 128;

/// Points whose side lines are looked at together: processors divide two or four numbers at a time.
const LANES: usize = 2;

/// Groups of as many points.
const GROUPS: usize = MAX_VERTICES.div_ceil(LANES);

/// What is seen, across the light: means and mean products of (p, q), relative to the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    mean: DVec2,
    /// Means of p², p q, q².
    products: DVec3,
}

/// A mean in the making.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    weight: f64,
    sum: DVec2,
    products: DVec3,
}

impl Sums {
    /// What is seen evenly between two points.
    fn add(&mut self, [from, to]: [DVec2; 2], weight: f64) {
        self.weight += weight;
        self.sum += (from + to) * (0.5 * weight);
        self.products += mean_products(from, to) * weight;
    }

    /// Not finite where nothing was added.
    fn mean(&self) -> Seen {
        Seen { mean: self.sum / self.weight, products: self.products / self.weight }
    }

    /// (2): with `anywhere` for what these samples have not seen.
    fn trusted(&self, anywhere: &Self) -> Seen {
        if self.weight == 0.0 {
            return anywhere.mean();
        }
        if !(anywhere.weight > 0.0) {
            return self.mean();
        }
        let trust = self.weight / (self.weight + ENOUGH_SAMPLES);
        let (anywhere, seen) = (anywhere.mean(), self.mean());
        Seen { mean: anywhere.mean.lerp(seen.mean, trust), products: anywhere.products.lerp(seen.products, trust) }
    }
}

impl Seen {
    /// Of a body in view, and of all that its map is looked up for; `samples` are positions that are seen, world space,
    /// any number of them.
    ///
    /// A map is looked up for its own slice, unless `held` says which points of render space the maps before it hold:
    /// then it is for all others that it holds, behind its slice as well. The body, as wide as it is, stands for what
    /// the map will hold.
    pub(crate) fn of(
        camera: &Camera,
        body: &FocusBody,
        sight: &Sight,
        samples: &[DVec3],
        origin: DVec3,
        held: Option<&dyn Fn(DVec3) -> bool>,
    ) -> [Self; 2] {
        // Anywhere in the body: (2), along rays.
        let mut anywhere = Sums::default();
        let sheaf = Sheaf::through(body, camera, origin);
        for (ends, span) in sheaf.spans(|vector| sight.light.ray(vector).truncate()) {
            anywhere.add(ends, span);
        }
        // Where surfaces are seen.
        let (mut own, mut served) = (Sums::default(), Sums::default());
        let [low, high] = if samples.is_empty() { [DVec2::ZERO; 2] } else { sight.bounds() };
        let last = body.vertices.iter().map(|v| sight.light.travel().dot(*v)).fold(f64::NEG_INFINITY, f64::max);
        let each = samples.len().div_ceil(MOST_ASKED);
        for (index, sample) in samples.iter().enumerate() {
            let place = *sample - origin;
            let at = sight.light.ray(place).truncate() - sight.eye;
            if !(at.cmpge(low).all() && at.cmple(high).all()) {
                continue;
            }
            let depth = camera.eye_depth(*sample, DVec3::ZERO);
            let within = body.depth.near <= depth && depth <= body.depth.far;
            if within {
                own.add([at; 2], 1.0);
            }
            let Some(held) = held.filter(|_| index % each == 0) else { continue };
            let behind = depth > body.depth.far && sight.light.travel().dot(place) <= last;
            if (within || behind) && !held(place) {
                served.add([at; 2], each as f64);
            }
        }
        let seen = own.trusted(&anywhere);
        [seen, if held.is_some() { served.trusted(&anywhere) } else { seen }]
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
        let of_group = |group: &[DVec2]| {
            let at = |lane: usize| group[lane.min(group.len() - 1)];
            [core::array::from_fn(|lane| at(lane).x), core::array::from_fn(|lane| at(lane).y)]
        };
        let points = outermost(frame, sight).chunks(LANES).map(of_group).collect();
        let mut along = Self { points, extent: frame.extent, moments: [0.0; 2] };
        along.moments = along.moments_of(frame, seen, sight);
        along
    }

    /// The same along the same axis for other things that are seen.
    pub(crate) fn of_others(&self, frame: &WarpFrame, seen: &Seen, sight: &Sight) -> Self {
        Self { moments: self.moments_of(frame, seen, sight), ..self.clone() }
    }

    fn moments_of(&self, frame: &WarpFrame, seen: &Seen, sight: &Sight) -> [f64; 2] {
        // u = axis · (x − eye) + shift.
        let (axis, shift) = (frame.axis, frame.axis.dot(sight.eye - frame.top));
        let mean = axis.dot(seen.mean);
        let squares = DVec3::new(axis.x * axis.x, 2.0 * axis.x * axis.y, axis.y * axis.y).dot(seen.products);
        let first = (mean + shift) / self.extent;
        let second = (squares + shift * (2.0 * mean + shift)) / (self.extent * self.extent);
        // Nothing is seen (a sliver between rays): what wants no warp.
        let share = |moment: f64| if moment.is_finite() { moment.clamp(0.0, 1.0) } else { 1.0 };
        [share(first), share(second)]
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

    /// The same, moved towards the least of `served` until what the map is looked up for besides is spared: continuous
    /// wherever the errors are.
    pub(crate) fn least_sparing(&self, served: &Self, limit: f64) -> f64 {
        let own = self.least(limit);
        let best = roughly_least(limit, |strength| served.error(strength));
        let most = (1.0 + SPARED) * served.error(best);
        if !(served.error(own) > most) {
            return own;
        }
        crossing(best, own, SPARED_CLOSE * most, |strength| served.error(strength) - most)
    }

    /// A strength, limited to what is predicted to be no worse than `uniform`, the error without a warp.
    pub(crate) fn guarded(&self, strength: f64) -> f64 {
        not_worse(strength, |strength| self.error(strength))
    }
}

/// u and c of the vertices of a body that a side line may go through: of those with c > 0 the ones that no other
/// surpasses in c at no greater u, of those with c < 0 likewise. Where all lie on one side of the axis, all.
/// O(vertices²) comparisons, for fewer divisions at each strength.
fn outermost(frame: &WarpFrame, sight: &Sight) -> ArrayVec<DVec2, MAX_VERTICES> {
    // Points before the top line are there by rounding.
    let place = |point: &DVec2| frame.coordinates(*point).max(DVec2::new(0.0, f64::NEG_INFINITY));
    let mut points: ArrayVec<DVec2, MAX_VERTICES> = sight.points.iter().map(place).collect();
    let both = points.iter().any(|point| point.y > 0.0) && points.iter().any(|point| point.y < 0.0);
    let mut index = 0;
    while both && index < points.len() {
        let point = points[index];
        let surpassed = |other: &DVec2| other.x <= point.x && other.y * point.y.signum() > point.y.abs();
        if point.y == 0.0 || points.iter().any(surpassed) {
            points.swap_remove(index);
        } else {
            index += 1;
        }
    }
    points
}

/// E without a warp, by the view's axis: the scale on which all methods are measured, whatever axis they bend along.
pub(crate) fn uniform_error(sight: &Sight) -> f64 {
    let frame = sight.frame;
    let [a0, a1] = frame.sides(0.0, &sight.points);
    a1 - a0 + frame.extent
}
