//! Which slices get a map: as many as the budget allows, and no more than the picture needs.
//!
//! Slices that f32 cannot tell apart are one slice. Slices are one as well where a map of both has texels hardly larger
//! than a map of the first alone (light along the view; receivers in the distance), or so small in the picture that
//! more would not be seen.
//!
//! # References
//! - `MATH.md` section 8: m, the size of a texel in pixels; 1 or less is no aliasing.

use arrayvec::ArrayVec;

use crate::fit::depth_range::{rounding, rounding_margin};
use crate::fit::snap::Stabilise;
use crate::fit::view::Fitter;
use crate::focus::FocusBody;
use crate::frame::{MAX_VIEWS, Select, ShadowFrame};
use crate::report::{Part, Why};
use crate::scene::DepthRange;
use crate::split::depth::{DepthSplits, MAX_PLANES, planes};
use crate::split::equal_error::{self, Cost};
use crate::split::profile::Profile;

/// Depth of a slice as a multiple of what f32 loses of positions: thinner ones are told apart by rounding alone. Larger
/// gives up slices that are of use.
const THINNEST: f64 = 4.0;

/// Texels may be larger by this share for a slice to join the one before it. At 0 no two slices ever join; at 1 every
/// second map is given away for texels of twice the size.
const HARDLY_LARGER: f64 = 0.05;

/// A slice with a map of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// Number of the split, from the nearest on; the first one of those that were joined.
    pub(crate) split: u8,
    /// Its eye depths.
    pub(crate) depth: DepthRange,
}

/// The slices that get a map, ascending, what f32 loses of places and depths there, and how wide they are.
pub(crate) struct Cuts {
    pub(crate) slices: ArrayVec<Cut, MAX_VIEWS>,
    pub(crate) margin: f64,
    pub(crate) profile: Profile,
}

impl Fitter<'_> {
    /// Cuts the eye depths `range` of a body. Of maps that stand still, those that this frame could do without are
    /// kept, because the next one may need them.
    pub(crate) fn cuts(
        &self,
        body: &FocusBody,
        range: DepthRange,
        splits: &DepthSplits,
        frame: &mut ShadowFrame,
    ) -> Cuts {
        let (camera, origin) = (&self.input.camera, self.input.origin);
        let budget = self.budget(splits, frame);
        let profile = Profile::of(body, camera, self.travel, origin);
        let planes = planes(&splits.scheme, budget, range.near, range.far)
            .unwrap_or_else(|| self.searched(&profile, budget, range, frame));
        // Receivers know their places and their depths as well as f32 does.
        let reach = range.near.abs().max(range.far.abs());
        let margin = rounding_margin(&body.vertices, origin).max(rounding(reach, origin));
        let still = self.how.stabilise == Stabilise::SnapTexels;
        let mut slices = ArrayVec::<Cut, MAX_VIEWS>::new();
        for (split, pair) in planes.windows(2).enumerate() {
            let (near, far, split) = (pair[0], pair[1], split as u8);
            let thin = !(far - near > THINNEST * margin);
            match slices.last_mut() {
                Some(before) if thin => {
                    before.depth.far = far;
                    frame.leave_out(Part::Split(split), Why::NoDepth);
                }
                Some(before) if !still && self.joins(&profile, splits, before.depth, pair, &planes) => {
                    before.depth.far = far;
                    frame.leave_out(Part::Split(split), Why::MetBy { split: before.split });
                }
                _ => slices.push(Cut { split, depth: DepthRange { near, far } }),
            }
        }
        Cuts { slices, margin, profile }
    }

    /// The planes of equal error: those of the previous frame as long as they are hardly worse. The next frame may keep
    /// them in turn.
    fn searched(
        &self,
        profile: &Profile,
        maps: u8,
        range: DepthRange,
        frame: &mut ShadowFrame,
    ) -> ArrayVec<f64, MAX_PLANES> {
        let before = self.input.previous.map_or(&[][..], |previous| &previous.planes);
        let cost = Cost::new(profile, &self.input.camera, self.input.scene.visible_points, range);
        frame.planes = equal_error::planes(&cost, maps, before);
        frame.planes.clone()
    }

    /// As many slices as there are texels for maps. Maps without room for their filter's border do not know what they
    /// hold.
    fn budget(&self, splits: &DepthSplits, frame: &mut ShadowFrame) -> u8 {
        let map = &self.input.map;
        let budget = u32::from(splits.maps).min(map.views).min(self.most_maps()) as u8;
        (budget..splits.maps).for_each(|split| frame.leave_out(Part::Split(split), Why::NoMapLeft));
        match self.texels.too_small() {
            Some(why) if splits.select == Select::Finest => {
                (1..budget).for_each(|split| frame.leave_out(Part::Split(split), why));
                1
            }
            _ => budget,
        }
    }

    /// Whether the slice between two planes may join the one before it.
    fn joins(&self, profile: &Profile, splits: &DepthSplits, before: DepthRange, next: &[f64], planes: &[f64]) -> bool {
        let joined = profile.size(before.near, next[1]);
        // Hardly larger than the first slice of those that are joined.
        let first_end = planes.iter().copied().find(|plane| *plane > before.near).unwrap_or(before.far);
        let alone = profile.size(before.near, first_end);
        if joined <= (1.0 + HARDLY_LARGER) * alone {
            return true;
        }
        // Or smaller than is seen, where pixels are smallest. Half of the sum is a side.
        let camera = &self.input.camera;
        let spread = if camera.projection.spreads() { before.near } else { 1.0 };
        let pixels = 0.5 * joined / self.texels.over_window() * camera.pixels_per_unit() / spread;
        pixels <= f64::from(splits.enough)
    }
}
