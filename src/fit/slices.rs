//! Several maps: one slice of what is in view after the other, each fitted as a single map would be.
//!
//! # References
//! - Zhang, Sun, Xu & Lu, *Parallel-split shadow maps for large-scale virtual environments*, 2006.

use arrayvec::ArrayVec;

use crate::content::Tile;
use crate::fit::cuts::{Cut, Cuts};
use crate::fit::snap::Stabilise;
use crate::fit::view::Fitter;
use crate::focus::FocusBody;
use crate::frame::{Footprint, MAX_VIEWS, Select, ShadowFrame};
use crate::report::{Part, Why};
use crate::scene::DepthRange;
use crate::split::Split;
use crate::split::depth::DepthSplits;

/// How far beyond its rim the last map is looked up, texture coordinates: as far as receivers are, which read lit
/// there.
const NO_RIM: f32 = -1e30;

/// Least length of a range of eye depths that is weighed, world units: below all that f64 tells apart, above all whose
/// product with an error vanishes.
const LEAST_LENGTH: f64 = 1e-200;

impl Fitter<'_> {
    /// Cuts a body in view into slices, shares the texels out among them, lays each out, and appends their views.
    ///
    /// Slices without receivers, without casters, or without depth get no map, slices that join their neighbours share
    /// one, and slices behind a map of the whole scene need none: the report says so.
    pub(crate) fn slices(&self, body: &FocusBody, splits: &DepthSplits, frame: &mut ShadowFrame) {
        let range = self.range(body);
        let mut cuts = self.cuts(body, range, splits, frame);
        let said = frame.left_out.len();
        let mut served = ArrayVec::<Cut, MAX_VIEWS>::new();
        // A map of the whole scene that was meant for one slice has to do for all that follow: share again.
        while let Some(whole) = self.lay_out_all(body, &cuts, splits, range, frame) {
            frame.take_back(said);
            let last = cuts.slices.last().map_or(range.far, |cut| cut.depth.far);
            served = cuts.slices.drain(whole + 1..).chain(served).collect();
            cuts.slices[whole].depth.far = last;
        }
        // That map, the last one; or why there is none.
        let whole = cuts.slices.last().map(|cut| cut.split);
        let last = frame.views.last().filter(|view| Some(view.split) == whole);
        let why = match last {
            Some(_) => Why::ServedBy { view: frame.views.len() as u8 - 1 },
            None => frame.left_out.last().map_or(Why::NothingCastsHere, |cut| cut.why),
        };
        served.iter().for_each(|next| frame.leave_out(Part::Split(next.split), why));
        self.finish(splits, range, frame);
    }

    /// One map for each slice that needs one; ends early with the number of a slice whose map turns out to be one of
    /// the whole scene, but was given fewer texels than a layer for that slice alone.
    fn lay_out_all(
        &self,
        body: &FocusBody,
        cuts: &Cuts,
        splits: &DepthSplits,
        range: DepthRange,
        frame: &mut ShadowFrame,
    ) -> Option<usize> {
        let Cuts { slices, margin, .. } = cuts;
        let tiles = self.tiles(cuts, range);
        let mut before = 0.0;
        for (number, cut) in slices.iter().enumerate() {
            // The slice, and the band in which the one before gives way to it.
            let DepthRange { near, far } = cut.depth;
            let depth = DepthRange { near: near - before - margin, far: far + margin };
            before = f64::from(splits.blend) * (far - near);
            let Some(mut slice) = body.slice(&self.input.camera, depth, self.input.origin) else {
                frame.leave_out(Part::Split(cut.split), Why::NoReceiversInView { near, far });
                continue;
            };
            // One map.
            let index = frame.views.len() as u8;
            let tile = tiles.get(number).copied().unwrap_or(Tile::whole(index.into(), self.tile.of));
            let texels = self.texels_for(&slice, tile.side);
            let fitter = Self { index, tile, texels, split: cut.split, ..*self };
            let said = frame.left_out.len();
            let layout = fitter.lay_out(&mut slice, frame);
            let followed = number + 1 < slices.len();
            if layout.whole && followed && tile.side < tile.of {
                return Some(number);
            }
            if let Err(why) = fitter.view(&slice, &layout, frame) {
                frame.left_out.truncate(said);
                frame.leave_out(Part::Split(cut.split), why);
                continue;
            }
            // What it serves; a map of the whole scene serves all that follows.
            let last = if layout.whole { slices.last().unwrap_or(cut) } else { cut }.depth;
            let band = f64::from(splits.blend) * (last.far - last.near);
            let served = DepthRange { near, far: last.far };
            frame.uniforms.views[usize::from(index)].domain = fitter.domain(splits, served, band);
            if layout.whole {
                let why = Why::ServedBy { view: index };
                slices[number + 1..].iter().for_each(|next| frame.leave_out(Part::Split(next.split), why));
                break;
            }
        }
        None
    }

    /// The eye depths to cut: those of the body; of maps that stand still, the camera's, which do so as well.
    fn range(&self, body: &FocusBody) -> DepthRange {
        let still = self.how.stabilise == Stabilise::SnapTexels && body.depth.far.is_finite();
        if still { body.depth } else { body.seen_depth(&self.input.camera, self.input.origin) }
    }

    /// What a shader has to know to find the map of a slice, which gives way over `band` world units.
    fn domain(&self, splits: &DepthSplits, DepthRange { near, far }: DepthRange, band: f64) -> [f32; 4] {
        let inverse = |width: f64| if width > 0.0 { width.recip() } else { 0.0 };
        let domain = match splits.select {
            Select::Depth => [near, far, far - band, inverse(band)],
            Select::Finest => {
                let [side, of] = [self.tile.side, self.tile.of].map(f64::from);
                [near, far, self.texels.read_beyond() / of, inverse(0.5 * f64::from(splits.blend) * (side / of))]
            }
        };
        domain.map(|depth| depth as f32)
    }

    /// One view serves everything, and gives way to nothing.
    pub(crate) fn finish_one(split: Split, frame: &mut ShadowFrame) {
        if matches!(split, Split::Depth(splits) if splits.fade) {
            frame.leave_out(Part::Fade, Why::NothingToFadeOver);
        }
        let Some(view) = frame.views.first() else { return };
        frame.predicted = view.texel.pixels;
        if split.selection().0 == Select::Finest {
            frame.uniforms.views[0].domain = [0.0, f32::MAX, NO_RIM, 1.0];
        }
    }

    /// The last view serves everything behind it, or gives way to light; what is predicted for all of them.
    fn finish(&self, splits: &DepthSplits, range: DepthRange, frame: &mut ShadowFrame) {
        let used = frame.views.len();
        let Some(last) = used.checked_sub(1) else { return };
        // A view whose neighbour was left out gives way to nothing: there is no receiver behind it that anything
        // shadows.
        let views = &mut frame.uniforms.views[..used];
        for index in 0..last {
            if views[index + 1].domain[0] > views[index].domain[1] && splits.select == Select::Depth {
                views[index].domain[3] = 0.0;
            }
        }
        if splits.fade && !(splits.blend > 0.0) {
            frame.leave_out(Part::Fade, Why::NothingToFadeOver);
        }
        let views = &mut frame.uniforms.views[..used];
        let [near, far, ..] = views[last].domain;
        match splits.select {
            Select::Depth if splits.fade => {}
            Select::Depth => views[last].domain = [near, f32::MAX, 0.0, 0.0],
            Select::Finest => {
                views[last].domain = [near, far, NO_RIM, 1.0];
                let band = splits.blend * (far - near);
                if splits.fade && band > 0.0 {
                    (views[0].across_v[3], views[0].across_w[3]) = (far - band, band.recip());
                }
            }
        }
        // Footprints over all views; the error by the share of what is seen in each.
        let seen = self.seen_by_view(range, frame);
        let mut predicted = Footprint { min: f32::INFINITY, ..Footprint::NONE };
        let (mut error, mut all) = (0.0, 0.0);
        for (view, seen) in frame.views.iter().zip(seen) {
            let pixels = view.texel.pixels;
            predicted.min = predicted.min.min(pixels.min);
            predicted.max = predicted.max.max(pixels.max);
            error += seen * f64::from(pixels.error);
            all += seen;
        }
        predicted.error = if all > 0.0 { (error / all) as f32 } else { 0.0 };
        frame.predicted = predicted;
    }

    /// How much is seen in the depths of each view: samples, or where there are none in any, depths.
    /// O(samples · views).
    fn seen_by_view(&self, range: DepthRange, frame: &ShadowFrame) -> [f64; MAX_VIEWS] {
        let domains = frame.uniforms.views.each_ref().map(|view| [view.domain[0], view.domain[1]].map(f64::from));
        let mut seen = [0.0; MAX_VIEWS];
        let mut none = true;
        for sample in self.input.scene.visible_points {
            let depth = self.input.camera.eye_depth(*sample, glam::DVec3::ZERO);
            let view = domains[..frame.views.len()].iter().position(|[near, far]| (*near..*far).contains(&depth));
            if let Some(view) = view {
                seen[view] += 1.0;
                none = false;
            }
        }
        // Where depths have no range, all views are one point.
        let length = |[near, far]: [f64; 2]| (far.min(range.far) - near).max(LEAST_LENGTH);
        if none { domains.map(length) } else { seen }
    }
}
