//! Several maps: one slice of what is in view after the other, each fitted as a single map would be.

use crate::fit::depth_range::{rounding, rounding_margin};
use crate::fit::layout::Layout;
use crate::fit::view::Fitter;
use crate::focus::FocusBody;
use crate::frame::{Footprint, Select, ShadowFrame};
use crate::report::{Part, Why};
use crate::scene::DepthRange;
use crate::split::depth::{DepthSplits, planes};
use crate::split::equal_error;

/// How far beyond its rim the last map is looked up, texture coordinates: as far as receivers are, which read lit there.
const NO_RIM: f32 = -1e30;

/// Depth of a slice as a multiple of what f32 loses of positions: thinner ones are told apart by rounding alone. Larger gives up slices
/// that are of use.
const THINNEST: f64 = 4.0;

impl Fitter<'_> {
    /// Cuts a body in view into slices, lays each out with `lay_out`, and appends their views; `range` are the eye depths to cut.
    ///
    /// Slices without receivers, without casters, or without depth get no map, and slices behind a map of the whole scene
    /// need none: the report says so.
    pub(crate) fn slices(
        &self,
        body: &FocusBody,
        range: DepthRange,
        splits: &DepthSplits,
        lay_out: impl Fn(&Self, &mut FocusBody, &mut ShadowFrame) -> Layout,
        frame: &mut ShadowFrame,
    ) {
        // As many slices as there are maps; maps without room for their filter's border do not know what they hold.
        let mut budget = u32::from(splits.maps).min(self.input.map.views).min(self.input.map.layers) as u8;
        (budget..splits.maps).for_each(|split| frame.leave_out(Part::Split(split), Why::NoMapLeft));
        if let Some(why) = self.texels.too_small().filter(|_| splits.select == Select::Finest) {
            (1..budget).for_each(|split| frame.leave_out(Part::Split(split), why));
            budget = 1;
        }
        let (camera, origin) = (&self.input.camera, self.input.origin);
        let planes = planes(&splits.scheme, budget, range.near, range.far).unwrap_or_else(|| {
            let samples = self.input.scene.visible_points;
            equal_error::planes(body, camera, self.travel, samples, origin, budget, range)
        });
        let blend = f64::from(splits.blend);
        // Receivers know their places and their depths as well as f32 does.
        let margin =
            rounding_margin(&body.vertices, origin).max(rounding(range.near.abs().max(range.far.abs()), origin));
        let (mut near, mut before) = (range.near, range.near);
        for split in 0..budget {
            let far = planes[usize::from(split) + 1];
            let last = split + 1 == budget;
            if !(far - near > THINNEST * margin || last) {
                frame.leave_out(Part::Split(split), Why::NoDepth);
                continue;
            }
            // The slice, and the band in which the one before gives way to it.
            let start = near;
            let from = start - blend * (start - before);
            (before, near) = (start, far);
            let depth = DepthRange { near: from - margin, far: far + margin };
            let Some(mut slice) = body.slice(camera, depth, origin) else {
                frame.leave_out(Part::Split(split), Why::NoReceiversInView { near: start, far });
                continue;
            };
            let index = frame.views.len() as u8;
            let fitter = Self { index, ..*self };
            let layout = lay_out(&fitter, &mut slice, frame);
            if let Err(why) = fitter.view(&slice, &layout, frame) {
                frame.leave_out(Part::Split(split), why);
                continue;
            }
            // A map of the whole scene serves all that follows.
            let (end, last_start) =
                if layout.whole { (range.far, planes[usize::from(budget) - 1]) } else { (far, start) };
            let (near, far, band) = (start, end, blend * (end - last_start));
            let domain = match splits.select {
                Select::Depth => [near, far, far - band, if band > 0.0 { band.recip() } else { 0.0 }],
                Select::Finest => [near, far, self.texels.read_beyond(), if blend > 0.0 { 2.0 / blend } else { 0.0 }],
            };
            frame.uniforms.views[usize::from(index)].domain = domain.map(|depth| depth as f32);
            if layout.whole {
                (split + 1..budget)
                    .for_each(|split| frame.leave_out(Part::Split(split), Why::ServedBy { view: index }));
                break;
            }
        }
        self.finish(splits, range, frame);
    }

    /// One view serves everything.
    pub(crate) fn finish_one(&self, select: Select, frame: &mut ShadowFrame) {
        let Some(view) = frame.views.first() else { return };
        frame.predicted = view.texel.pixels;
        if select == Select::Finest {
            frame.uniforms.views[0].domain = [0.0, f32::MAX, NO_RIM, 1.0];
        }
    }

    /// The last view serves everything behind it, or gives way to light; what is predicted for all of them.
    fn finish(&self, splits: &DepthSplits, range: DepthRange, frame: &mut ShadowFrame) {
        let used = frame.views.len();
        let Some(last) = used.checked_sub(1) else { return };
        // A view whose neighbour was left out gives way to nothing: there is no receiver behind it that anything shadows.
        let views = &mut frame.uniforms.views[..used];
        for index in 0..last {
            if views[index + 1].domain[0] > views[index].domain[1] && splits.select == Select::Depth {
                views[index].domain[3] = 0.0;
            }
        }
        let domain = &mut views[last].domain;
        match splits.select {
            Select::Depth if splits.fade => {}
            Select::Depth => *domain = [domain[0], f32::MAX, 0.0, 0.0],
            Select::Finest => (domain[2], domain[3]) = (NO_RIM, 1.0),
        }
        // Footprints over all views; the error by the share of what is seen in each.
        let mut predicted = Footprint { min: f32::INFINITY, ..Footprint::NONE };
        let (mut error, mut seen) = (0.0, 0.0);
        for (view, uniforms) in frame.views.iter().zip(&frame.uniforms.views) {
            let [near, far] = [uniforms.domain[0], uniforms.domain[1]].map(|depth| f64::from(depth).min(range.far));
            let share = self.share_seen(DepthRange { near, far });
            let pixels = view.texel.pixels;
            predicted.min = predicted.min.min(pixels.min);
            predicted.max = predicted.max.max(pixels.max);
            error += share * f64::from(pixels.error);
            seen += share;
        }
        predicted.error = if seen > 0.0 { (error / seen) as f32 } else { 0.0 };
        frame.predicted = predicted;
    }

    /// How much is seen between two eye depths: samples, or where none are given, depths.
    fn share_seen(&self, DepthRange { near, far }: DepthRange) -> f64 {
        let points = self.input.scene.visible_points;
        if points.is_empty() {
            return far - near;
        }
        let camera = &self.input.camera;
        let depths = points.iter().map(|point| camera.eye_depth(*point, glam::DVec3::ZERO));
        depths.filter(|depth| (near..far).contains(depth)).count() as f64
    }
}
