//! Split depths of the least predicted picture error.
//!
//! A map of a fixed number of texels has texels as large as what it covers, and a shadow edge is displaced by about
//! half of one (see `warp::least_error`). What a picture gets wrong is then the sum over slices of their extent across
//! the light times what is seen in them:
//!
//! ```text
//! (1)  E(C) = Σ_i s(C_i, C_i+1) T(C_i, C_i+1)
//! (2)  T: width + height of the slice of the body as the light sees it, one side along the view
//! (3)  s: share of the samples of what is seen; without any, of the logarithm of depth
//! ```
//!
//! Moving one plane changes two summands, and each plane in turn is moved to where their sum is least, a few times
//! over.
//!
//! The sum is flat: planes move far for little, and two valleys can be equally deep. On 100 smooth paths of 64 steps,
//! one of the planes of four slices moves by more than 10 % in 3.0 % of the steps (7.6 % with samples), mostly at one
//! point of time; the least sum of all sets of planes, instead of a local one, leaps nearly as often. Where the frame
//! before is given, its planes stay until others are 5 % better: 0.8 % of the steps (1.5 %), for 0.5 % of the sum.
//! Where none is given they may leap.
//!
//! # What it leaves out
//! - The warp, which takes more from some slices than from others, and that receivers just behind a plane are still
//!   found in the map before it ([`Select::Finest`](crate::Select::Finest)). Measured over the pictures of
//!   `docs/SPLITS.md`, which has the numbers: planes of the least error of the warped maps, taken from whole fits, have
//!   no fewer wrong pixels than these. Both together, looked up sample by sample, have 3 to 6 % fewer where samples are
//!   given, for hundreds of fits a picture, and as many where none are; whatever costs a few flops a slice gains on one
//!   set of pictures and loses on the other.
//!
//! # References
//! - Lauritzen, Salvi & Lefohn, *Sample distribution shadow maps*, 2011: splits from what is seen.
//! - Lloyd, Tuft, Yoon & Manocha, *Warping and partitioning for low error shadow maps*, 2006: error of splits in one
//!   dimension.

use arrayvec::ArrayVec;
use glam::DVec3;

use super::depth::{MAX_PLANES, Scheme, planes as planes_of};
use super::profile::{Profile, Section};
use crate::camera::Camera;
use crate::math::search::valley;
use crate::scene::{DepthRange, ENOUGH_SAMPLES};

/// λ of the planes that the search begins with: between what is best with and without knowledge of what is seen.
const START: f32 = 0.75;

/// How often every plane is moved. Once leaves planes that moved before their neighbours did; more than four move
/// nothing.
const SWEEPS: u32 = 3;

/// How near to its best place each search leaves a plane, as a share of the way between its neighbours: the sum is flat
/// there, and they move next.
const NEAR: f64 = 0.01;

/// Classes of depth in which samples are counted. Fewer blur where things are; more are emptier than samples are many.
const CLASSES: usize = 48;

/// By which share of the sum other planes must be better than those of the frame before. At 0 planes leap from one
/// valley to the next as soon as that is deeper by rounding; at 1 they never move, however wrong they have become.
const KEPT: f64 = 0.05;

/// What a slice costs, as a function of its planes.
pub(crate) struct Cost<'a> {
    profile: &'a Profile,
    range: DepthRange,
    /// Classes over the logarithm of depth; over depth where it has none.
    scale: f64,
    /// Share of what is seen before the end of each class.
    seen: [f64; CLASSES + 1],
}

/// The planes of `maps` slices, ascending, ends included: those of the frame before, unless others are better by
/// [`KEPT`]. `before`: its planes, of any range; of another number of slices, they are not read.
///
/// Kind of promise: typical; a local optimum. A frame that follows itself has the same planes, bit by bit.
/// O(maps · edges) evaluations of a few flops.
pub(crate) fn planes(cost: &Cost, maps: u8, before: &[f64]) -> ArrayVec<f64, MAX_PLANES> {
    let found = cost.searched(maps);
    if before.len() != found.len() {
        return found;
    }
    let kept = cost.clamped(before);
    if cost.of(&found) < (1.0 - KEPT) * cost.of(&kept) { found } else { kept }
}

/// A plane, and what summands of (1) need of it.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// Its place in classes of depth.
    class: f64,
    /// Share of what is seen before it.
    before: f64,
    section: Section,
}

/// Length of a range in the logarithm of depth; in depth where it has none.
fn span(DepthRange { near, far }: DepthRange) -> f64 {
    // The nearest near planes have a ratio beyond f64.
    if near > 0.0 { (far / near).min(f64::MAX).ln() } else { far - near }
}

impl<'a> Cost<'a> {
    /// From samples of what is seen, O(samples); none is fine.
    pub(crate) fn new(profile: &'a Profile, camera: &Camera, samples: &[DVec3], range: DepthRange) -> Self {
        let mut cost = Self { profile, range, scale: CLASSES as f64 / span(range), seen: [0.0; CLASSES + 1] };
        // Count what is seen; what is not known is spread evenly.
        let mut count = 0.0;
        for sample in samples {
            let depth = camera.eye_depth(*sample, DVec3::ZERO);
            if range.near <= depth && depth <= range.far {
                cost.seen[(cost.class(depth) as usize).min(CLASSES - 1) + 1] += 1.0;
                count += 1.0;
            }
        }
        let trust = count / (count + ENOUGH_SAMPLES);
        let mut before = 0.0;
        for seen in cost.seen.iter_mut().skip(1) {
            let share = if count > 0.0 { *seen / count } else { 0.0 };
            before += trust * share + (1.0 - trust) / CLASSES as f64;
            *seen = before;
        }
        cost
    }

    /// Depth in classes, 0 to [`CLASSES`].
    fn class(&self, depth: f64) -> f64 {
        let near = self.range.near;
        let class = span(DepthRange { near, far: depth }) * self.scale;
        // 0/0 where there is no range.
        if class.is_finite() { class.clamp(0.0, CLASSES as f64) } else { 0.0 }
    }

    /// The depth of a class.
    fn depth(&self, class: f64) -> f64 {
        let DepthRange { near, far } = self.range;
        let along = class / self.scale;
        let depth = if near > 0.0 { near * along.exp() } else { near + along };
        depth.clamp(near, far)
    }

    /// Share of what is seen before a class.
    fn before(&self, class: f64) -> f64 {
        let whole = (class as usize).min(CLASSES - 1);
        self.seen[whole] + (self.seen[whole + 1] - self.seen[whole]) * (class - whole as f64)
    }

    fn plane(&self, class: f64, depth: f64) -> Plane {
        Plane { class, before: self.before(class), section: self.profile.section(depth) }
    }

    /// (3).
    pub(crate) fn seen(&self, near: f64, far: f64) -> f64 {
        self.before(self.class(far)) - self.before(self.class(near))
    }

    /// Planes of a local optimum.
    fn searched(&self, maps: u8) -> ArrayVec<f64, MAX_PLANES> {
        let start = Scheme::Practical { lambda: START, offset: 0.0 };
        let mut depths = planes_of(&start, maps, self.range.near, self.range.far).unwrap_or_default();
        let mut planes: ArrayVec<Plane, MAX_PLANES> =
            depths.iter().map(|depth| self.plane(self.class(*depth), *depth)).collect();
        for _ in 0..SWEEPS {
            for index in 1..planes.len().saturating_sub(1) {
                let (before, after) = (planes[index - 1], planes[index + 1]);
                let at = |class: f64| self.plane(class, self.depth(class));
                let ends = [before.class, after.class];
                let (class, _) = valley(ends, NEAR * (ends[1] - ends[0]), |class| {
                    let plane = at(class);
                    self.of_slice(&before, &plane) + self.of_slice(&plane, &after)
                });
                planes[index] = at(class);
                depths[index] = planes[index].section.depth();
            }
        }
        depths
    }

    /// Planes of another range, in this one: its ends, and what is beyond them moved to them.
    fn clamped(&self, planes: &[f64]) -> ArrayVec<f64, MAX_PLANES> {
        let DepthRange { near, far } = self.range;
        let last = planes.len().saturating_sub(1);
        let within = |(index, plane): (usize, &f64)| match index {
            0 => near,
            index if index == last => far,
            _ => plane.max(near).min(far),
        };
        planes.iter().take(MAX_PLANES).enumerate().map(within).collect()
    }

    /// (1).
    fn of(&self, depths: &[f64]) -> f64 {
        let plane = |depth: &f64| self.plane(self.class(*depth), *depth);
        let planes: ArrayVec<Plane, MAX_PLANES> = depths.iter().take(MAX_PLANES).map(plane).collect();
        planes.windows(2).map(|pair| self.of_slice(&pair[0], &pair[1])).sum()
    }

    /// One summand of (1).
    fn of_slice(&self, near: &Plane, far: &Plane) -> f64 {
        (far.before - near.before) * self.profile.between(&near.section, &far.section)
    }
}
