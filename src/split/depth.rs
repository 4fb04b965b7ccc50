//! Depth splits: parallel planes that cut a range of eye depths into slices, one map each.
//!
//! ```text
//! (1)  uniform      C_i = n + (f − n) i/m
//! (2)  logarithmic  C_i = n (f/n)^(i/m)
//! (3)  practical    C_i = λ (2) + (1 − λ) (1) + b,   b for 0 < i < m alone
//! (4)  equal error  the C_i of the least sum over slices of (texels' size in the world × what is seen there)
//! ```
//!
//! (2) makes every slice as many times as deep as the one before, and with it the worst perspective error equal in all
//! of them; where near and far are far apart it spends most maps on what hardly fills the picture. (3) is the
//! compromise of the papers.
//!
//! # Where this differs from print
//! - TH-10: the thesis adds b to all planes, 0 ≤ i ≤ m; that moves the ends of the range. Here it moves interior planes
//!   only, and no further than their neighbours.
//! - TH-11: "logarithmic over-samples near, under-samples far": it equalises perspective error. What it wastes is maps,
//!   on tiny slices.
//!
//! # References
//! - Zhang, Sun, Xu & Lu, *Parallel-split shadow maps for large-scale virtual environments*, 2006: (1) to (3), λ = ½.
//! - Lauritzen, Salvi & Lefohn, *Sample distribution shadow maps*, 2011: the range from what is seen.
//! - `MATH.md` section 4; section 10 rows 8 and 9.

use arrayvec::ArrayVec;

use crate::error::{FitError, LARGEST, within};
pub use crate::frame::MAX_PLANES;
use crate::frame::{MAX_VIEWS, Select};

/// Largest share of a slice over which it may give way to the next one. At 1 every point would be looked up twice.
const MOST_BLEND: f64 = 0.5;

/// Most pixels of a texel that may be called enough: blocks of shadow that anyone sees.
const MOST_PIXELS: f64 = 16.0;

/// Maps for ranges of eye depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthSplits {
    /// Maps at most, 1 to 8. Slices without receivers or casters get none.
    pub maps: u8,
    /// Where the planes between them are.
    pub scheme: Scheme,
    /// How receivers find their map.
    pub select: Select,
    /// Share of a slice, from its far end, over which it gives way to the next one, 0 (a hard edge) to 0.5. Costs a
    /// second lookup there.
    pub blend: f32,
    /// Whether the last slice gives way to light, over the same share: shadows end softly at the visible depth. Not
    /// where one map serves all, or the share is 0, and the report says so.
    pub fade: bool,
    /// Pixels that a texel may measure for more maps not to pay, 0 (use all of them) to 16. Shadow edges are off by
    /// half of it.
    pub enough: f32,
}

/// Where the planes between slices are.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Scheme {
    /// (1): slices of equal length.
    Uniform,
    /// (2): slices that are longer by equal factors.
    Logarithmic,
    /// (3): between those.
    Practical {
        /// λ, 0 (uniform) to 1 (logarithmic).
        lambda: f32,
        /// b, world units, ±1e15: moves all planes between slices.
        offset: f32,
    },
    /// Eye depths of the planes between slices, world units, ascending; as many as there are maps, less one, are read.
    /// Planes outside of what is in view are left out with their slices.
    Manual([f32; MAX_VIEWS - 1]),
    /// (4): where the predicted picture error is least. Planes of the previous frame stay until others are better by
    /// 5 %.
    EqualError,
}

impl Default for DepthSplits {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl DepthSplits {
    /// Four maps of equal error, the finest that holds a receiver, hard edges.
    pub const DEFAULT: Self =
        Self { maps: 4, scheme: Scheme::EqualError, select: Select::Finest, blend: 0.0, fade: false, enough: 0.25 };

    /// As many maps as there are depths, and one more: `planes` are the eye depths between them, world units,
    /// ascending. At most seven are read.
    #[must_use]
    pub fn manual(planes: &[f32]) -> Self {
        let mut depths = [f32::INFINITY; MAX_VIEWS - 1];
        let read = planes.len().min(depths.len());
        depths[..read].copy_from_slice(&planes[..read]);
        Self { maps: read as u8 + 1, scheme: Scheme::Manual(depths), ..Self::default() }
    }

    /// The first map ends at eye depth `first`, the last one at `far`, and each map between them is as many times as
    /// deep as the one before: `first (far/first)^(i/(maps − 1))`. Of other numbers than
    /// 0 < first ≤ far, `fit` refuses what does not ascend; a single plane may be anywhere, and is left out beyond what
    /// is in view.
    ///
    /// Bevy's cascades are `exponential(4, 10.0, 150.0)` with `select: Select::Depth`, `blend: 0.2` (of a cascade's
    /// length here, of its far end there), `enough: 0.0`, [`Stabilise::SnapTexels`](crate::Stabilise::SnapTexels), and
    /// a `visible_depth` of 0.1 to 150.
    #[must_use]
    pub fn exponential(maps: u8, first: f32, far: f32) -> Self {
        let between = maps.clamp(1, MAX_VIEWS as u8) - 1;
        let mut depths = [f32::INFINITY; MAX_VIEWS - 1];
        for (index, depth) in depths.iter_mut().enumerate().take(usize::from(between)) {
            *depth = first * (far / first).powf(index as f32 / f32::from(between));
        }
        Self { maps, scheme: Scheme::Manual(depths), ..Self::default() }
    }

    /// Checks its numbers.
    pub(crate) fn validate(&self) -> Result<(), FitError> {
        within("split.maps", f32::from(self.maps), [1.0, MAX_VIEWS as f64], "1 to 8")?;
        within("split.blend", self.blend, [0.0, MOST_BLEND], "0 to 0.5")?;
        within("split.enough", self.enough, [0.0, MOST_PIXELS], "0 to 16")?;
        match &self.scheme {
            Scheme::Practical { lambda, offset } => {
                within("split.scheme.lambda", *lambda, [0.0, 1.0], "0 to 1")?;
                within("split.scheme.offset", *offset, [-LARGEST, LARGEST], "-1e15 to 1e15")
            }
            Scheme::Manual(depths) => {
                let read = &depths[..usize::from(self.maps) - 1];
                for pair in read.windows(2) {
                    if !(pair[0] <= pair[1]) {
                        return Err(FitError::NotOrdered {
                            lower: "split.scheme.manual[i]",
                            lower_value: pair[0].into(),
                            upper: "split.scheme.manual[i + 1]",
                            upper_value: pair[1].into(),
                            legal: "ascending",
                        });
                    }
                }
                match read.iter().find(|depth| depth.is_nan()) {
                    Some(depth) => Err(FitError::NotFinite { field: "split.scheme.manual", value: f64::from(*depth) }),
                    None => Ok(()),
                }
            }
            _ => Ok(()),
        }
    }
}

/// The planes of `maps` slices of the range, ascending, ends included: one more than there are slices. `None` for
/// schemes that need more than the range.
///
/// Kind of promise: exact up to rounding; ascending for every range with near ≤ far. Depths of zero or below have no
/// logarithm: (1) there.
#[must_use]
pub fn planes(scheme: &Scheme, maps: u8, near: f64, far: f64) -> Option<ArrayVec<f64, MAX_PLANES>> {
    let maps = maps.clamp(1, MAX_VIEWS as u8);
    let share = |index: u8| f64::from(index) / f64::from(maps);
    let uniform = |index: u8| near + (far - near) * share(index);
    let logarithmic = |index: u8| if near > 0.0 { near * (far / near).powf(share(index)) } else { uniform(index) };
    let plane = |index: u8| match scheme {
        Scheme::Uniform => uniform(index),
        Scheme::Logarithmic => logarithmic(index),
        Scheme::Practical { lambda, offset } => {
            let lambda = f64::from(*lambda);
            lambda * logarithmic(index) + (1.0 - lambda) * uniform(index) + f64::from(*offset)
        }
        Scheme::Manual(depths) => f64::from(depths[usize::from(index) - 1]),
        Scheme::EqualError => f64::NAN,
    };
    if matches!(scheme, Scheme::EqualError) && maps > 1 {
        return None;
    }
    let mut planes = ArrayVec::new();
    planes.push(near);
    let mut last = near;
    for index in 1..maps {
        // Neither before the plane before nor behind the end, whatever offsets and rounding say.
        last = plane(index).max(last).min(far);
        planes.push(last);
    }
    planes.push(far);
    Some(planes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn found(scheme: Scheme, maps: u8, near: f64, far: f64) -> Vec<f64> {
        planes(&scheme, maps, near, far).unwrap().to_vec()
    }

    const HALF: Scheme = Scheme::Practical { lambda: 0.5, offset: 0.0 };

    /// `MATH.md` section 10 rows 8 and 9.
    #[test]
    fn golden_values() {
        let close = |found: Vec<f64>, expected: &[f64], tolerance: f64| {
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() <= tolerance * expected, "{found} instead of {expected}");
            }
        };
        let log = [1.0, 3.162_277_660_168_379, 10.0, 31.622_776_601_683_793, 100.0];
        close(found(Scheme::Logarithmic, 4, 1.0, 100.0), &log, 1e-14);
        let practical = [1.0, 14.456_138_830_084_2, 30.25, 53.436_388_300_841_9, 100.0];
        close(found(HALF, 4, 1.0, 100.0), &practical, 1e-14);
        close(found(HALF, 3, 1.0, 50.0), &[1.0, 10.508_682, 23.619_377, 50.0], 5e-8);
        close(found(HALF, 3, 15.0, 5000.0), &[15.0, 890.335_429, 2_029.729_059, 5000.0], 5e-10);
        close(found(Scheme::Logarithmic, 3, 15.0, 5000.0), &[15.0, 104.004_191, 721.124_785, 5000.0], 5e-9);
    }

    /// TH-10: b = 2 on [1, 100] would move the ends to 3 and 102.
    #[test]
    fn offsets_move_planes_between_slices_alone() {
        let with = found(Scheme::Practical { lambda: 0.5, offset: 2.0 }, 4, 1.0, 100.0);
        let without = found(HALF, 4, 1.0, 100.0);
        assert_eq!((with[0], with[4]), (1.0, 100.0));
        for index in 1..4 {
            assert!((with[index] - without[index] - 2.0).abs() < 1e-12);
        }
    }

    proptest! {
        /// Whatever is legal gives ascending planes from end to end.
        #[test]
        fn planes_ascend(
            maps in 1..=8_u8, kind in 0..4, lambda in 0.0..=1.0_f32, offset in prop_oneof![Just(0.0_f32), -1e15..1e15_f32, -10.0..10.0_f32],
            near in prop_oneof![Just(0.0), -10.0..10.0_f64, 1e-6..1e6_f64], length in prop_oneof![Just(0.0), 0.0..1e9_f64, 1e-9..1.0_f64],
            mut depths in prop::array::uniform7(prop_oneof![Just(f32::INFINITY), -10.0..1e6_f32]),
        ) {
            depths.sort_by(f32::total_cmp);
            let scheme = match kind {
                0 => Scheme::Uniform,
                1 => Scheme::Logarithmic,
                2 => Scheme::Practical { lambda, offset },
                _ => Scheme::Manual(depths),
            };
            let splits = DepthSplits { maps, scheme, ..DepthSplits::default() };
            prop_assert!(splits.validate().is_ok());
            let far = near + length;
            let planes = found(scheme, maps, near, far);
            prop_assert_eq!(planes.len(), usize::from(maps) + 1);
            prop_assert!(planes.is_sorted() && planes.iter().all(|plane| plane.is_finite()), "{:?}", planes);
            prop_assert_eq!((planes[0], planes[usize::from(maps)]), (near, far));
        }
    }

    /// Bevy 0.19: `calculate_cascade_bounds` of 4 cascades, first bound 10, maximum distance 150.
    #[test]
    fn exponential_planes() {
        let splits = DepthSplits::exponential(4, 10.0, 150.0);
        let planes = found(splits.scheme, 4, 0.1, 150.0);
        for (found, expected) in planes.iter().zip([0.1, 10.0, 24.662_121, 60.822_02, 150.0]) {
            assert!((found - expected).abs() < 1e-5 * expected, "{planes:?}");
        }
        assert!(splits.validate().is_ok());
        assert!(DepthSplits::exponential(4, -1.0, 150.0).validate().is_err());
        assert!(DepthSplits::exponential(1, 10.0, 150.0).validate().is_ok());
    }

    #[test]
    fn bad_numbers_are_named() {
        let splits = DepthSplits::default();
        for (splits, field) in [
            (DepthSplits { maps: 0, ..splits }, "split.maps"),
            (DepthSplits { maps: 9, ..splits }, "split.maps"),
            (DepthSplits { blend: 0.6, ..splits }, "split.blend"),
            (DepthSplits { blend: f32::NAN, ..splits }, "split.blend"),
            (DepthSplits { scheme: Scheme::Practical { lambda: 1.5, offset: 0.0 }, ..splits }, "split.scheme.lambda"),
            (DepthSplits { scheme: Scheme::Practical { lambda: 0.5, offset: 2e15 }, ..splits }, "split.scheme.offset"),
            (DepthSplits::manual(&[10.0, 5.0]), "split.scheme.manual"),
            (DepthSplits::manual(&[f32::NAN]), "split.scheme.manual"),
        ] {
            let text = splits.validate().expect_err(field).to_string();
            assert!(text.contains(field), "{text}");
        }
        assert!(DepthSplits::manual(&[5.0, 10.0]).validate().is_ok());
    }
}
