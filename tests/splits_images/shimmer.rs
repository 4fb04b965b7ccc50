//! Shadow edges while the camera moves over a scene that stands still: change that the truth does not have.

use antumbra::lab::bvh::{Bvh, Ray};
use antumbra::lab::cpu::Visible;
use antumbra::lab::raster::Hit;
use antumbra::lab::sparse_city::sparse_city;
use antumbra::lab::subject::{Setting, Subject, case_of};
use antumbra::lab::treeline::treeline;
use antumbra::lab::viewpoints::{PathKind, Viewpoint, path, sparse_city_viewpoints, treeline_viewpoints};
use antumbra::{Encoding, Light, Pcf, Remix, Stabilise, techniques};
use rayon::prelude::*;

use crate::PICTURE;
use crate::drawn::Drawn;

/// Frames of a path, 1/60 s apart; those that are drawn are its first. Fewer leave the mean to chance, more take
/// longer, and a head that has turned far looks at nothing.
const PATH: usize = 300;
const FRAMES: usize = 24;

/// Where a shadow ray starts, world units; scenes are some 10² to 10⁴ wide.
const SHADOW_START: f64 = 1e-6;

/// Side of maps and filter for which the bound is set.
const BOUNDED: (u32, Pcf) = (1024, Pcf::Hardware2x2);

/// Others, measured on one path alone.
const OTHERS: [(u32, Pcf); 3] = [(512, Pcf::Hardware2x2), (2048, Pcf::Hardware2x2), (1024, Pcf::Box5x5)];

/// Where that path starts.
const OTHERS_FROM: &str = "treeline-across";

/// Most that snapping may leave of the shimmer of a fixed point.
const MOST_LEFT: f64 = 0.5;

/// Least shimmer of tight maps for which that says anything.
const LEAST: f64 = 5e-4;

/// One frame of a path: what is seen, and what is lit at the centres of pixels (none: nothing there faces the light).
struct Frame {
    setting: Setting,
    visible: Visible,
    lit: Vec<Option<f32>>,
}

impl Frame {
    fn new(subject: &Subject, bvh: &Bvh, viewpoint: &Viewpoint) -> Self {
        let mut case = case_of(viewpoint, &subject.model.name);
        case.viewport = PICTURE;
        let setting = Setting::of(&case);
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        let pixels = PICTURE[0] as usize * PICTURE[1] as usize;
        let lit = |pixel| visible.pixel(pixel).and_then(|hit| lit(bvh, &setting, hit));
        let lit = (0..pixels).into_par_iter().map(lit).collect();
        Self { setting, visible, lit }
    }

    /// What a pixel shows that faces the light.
    fn pixel(&self, pixel: usize) -> Option<(&Hit, f32)> {
        Some((self.visible.pixel(pixel)?, self.lit[pixel]?))
    }
}

/// Whether light reaches a visible point.
fn lit(bvh: &Bvh, setting: &Setting, hit: &Hit) -> Option<f32> {
    let Light::Directional { travel } = setting.light else { return None };
    if !(hit.normal.dot(travel) < 0.0) {
        return None;
    }
    let origin = hit.position + setting.origin;
    let ray = Ray { origin, direction: -travel, t_min: SHADOW_START, t_max: f64::INFINITY };
    Some(if bvh.is_blocked(&ray, Some(hit.triangle)) { 0.0 } else { 1.0 })
}

/// Means over points.
#[derive(Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, value: f32) {
        self.sum += f64::from(value.abs());
        self.count += 1;
    }

    fn value(self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// Change from frame to frame that the truth does not have, means.
#[derive(Clone, Copy, Default)]
struct Shimmer {
    /// |mask − truth| of pixels: what is wrong in each frame alone.
    error: Mean,
    /// |Δmask − Δtruth| of pixels that show geometry facing the light in both frames.
    pixels: Mean,
    /// The same if the maps of the earlier frame served both: pixels that slide over edges which stand still.
    sliding: Mean,
    /// |Δlookup| of the surface points of the earlier frame; their truth stands still.
    points: Mean,
    /// The same of those that one map serves in both frames.
    same_map: Mean,
}

/// What one pixel of a frame adds.
struct Change {
    error: f32,
    point: f32,
    same_map: bool,
    /// Of the pixel, and with the earlier maps.
    pixel: Option<[f32; 2]>,
}

impl Shimmer {
    fn add(&mut self, change: &Change) {
        self.error.add(change.error);
        self.points.add(change.point);
        if change.same_map {
            self.same_map.add(change.point);
        }
        if let Some([pixel, sliding]) = change.pixel {
            self.pixels.add(pixel);
            self.sliding.add(sliding);
        }
    }
}

fn shimmer(subject: &Subject, frames: &[Frame], remix: &Remix, side: u32) -> Shimmer {
    let draw = |frame: &Frame| Drawn::new(subject, &frame.setting, remix, side);
    let mut found = Shimmer::default();
    let mut old = draw(&frames[0]);
    for frames in frames.windows(2) {
        let [before, after] = [&frames[0], &frames[1]];
        let new = draw(after);
        let look = |pixel: usize| {
            // The surface point of the earlier frame in both.
            let (hit, truth) = before.pixel(pixel)?;
            let point = hit.position + before.setting.origin;
            let was = old.lit(point, hit.normal);
            let change = new.lit(point, hit.normal) - was;
            let same_map = old.serving(point, hit.normal) == new.serving(point, hit.normal);
            // The pixel in both.
            let pixel = after.pixel(pixel).map(|(hit, truth_after)| {
                let point = hit.position + after.setting.origin;
                [&new, &old].map(|maps| maps.lit(point, hit.normal) - was - (truth_after - truth))
            });
            Some(Change { error: was - truth, point: change, same_map, pixel })
        };
        let looked: Vec<_> = (0..before.lit.len()).into_par_iter().filter_map(look).collect();
        for change in &looked {
            found.add(change);
        }
        old = new;
    }
    found
}

/// Photographs a path with tight and with snapped maps; prints and returns what shimmers of fixed points.
fn compare(name: &str, subject: &Subject, frames: &[Frame], (side, filter): (u32, Pcf)) -> [f64; 2] {
    let remix = |stabilise| Remix { stabilise, encoding: Encoding::Depth(filter), ..techniques::pssm() };
    let of = |stabilise| shimmer(subject, frames, &remix(stabilise), side);
    let (off, snapped) = rayon::join(|| of(Stabilise::Off), || of(Stabilise::SnapTexels));
    let both = [off, snapped];
    let means: [fn(&Shimmer) -> Mean; 5] = [
        |found| found.pixels,
        |found| found.sliding,
        |found| found.error,
        |found| found.points,
        |found| found.same_map,
    ];
    let columns = means.map(|mean| {
        let [off, snapped] = both.each_ref().map(|found| mean(found).value());
        format!("{off:.5} / {snapped:.5}")
    });
    let [pixels, points] = [means[0], means[3]].map(|mean| mean(&snapped).value() / mean(&off).value());
    println!("| {name} | {side} {} | {} | {pixels:.2} | {points:.3} |", filter.name(), columns.join(" | "));
    both.map(|found| found.points.value())
}

fn measure(name: &str, subject: &Subject, start: &Viewpoint, broken: &mut Vec<String>) {
    let bvh = Bvh::new(&subject.model);
    for kind in [PathKind::Dolly, PathKind::Turn, PathKind::Orbit] {
        let viewpoints = path(kind, start, PATH);
        let frames: Vec<Frame> =
            viewpoints[..FRAMES].par_iter().map(|viewpoint| Frame::new(subject, &bvh, viewpoint)).collect();
        let name = format!("{name} {kind:?}");
        let [off, snapped] = compare(&name, subject, &frames, BOUNDED);
        if !(snapped <= MOST_LEFT * off) || !(off >= LEAST) {
            broken.push(format!("{name}: {snapped} of {off}"));
        }
        if kind == PathKind::Orbit && start.name == OTHERS_FROM {
            for map in OTHERS {
                compare(&name, subject, &frames, map);
            }
        }
    }
}

/// Snapped maps leave at most half of the shimmer of what stands still in the world.
///
/// Not of what stands still in the picture. There each pixel shows another point in each frame and meets errors of
/// other texels, of maps that move or do not; where pixels move over texels faster than edges crawl, that is most of
/// the change, and the larger texels of snapped maps make it larger.
#[test]
fn snapped_maps_shimmer_less() {
    println!("Three parallel splits, tight / snapped, {FRAMES} frames: mean change that the truth does not have.");
    println!(
        "Sliding: pixels, with the maps of the earlier frame for both. Error: |mask − truth|. Points: of the world."
    );
    println!("| path | map | pixels | sliding | error | points | points of one map | pixels: ratio | points: ratio |");
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|");
    let mut broken = Vec::new();
    measure("treeline across", &Subject::new(treeline()), &treeline_viewpoints()[0], &mut broken);
    measure("sparse-city across", &Subject::new(sparse_city()), &sparse_city_viewpoints()[0], &mut broken);
    assert!(broken.is_empty(), "{broken:#?}");
}
