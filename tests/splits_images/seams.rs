//! Where one map gives way to the next: a blend is no worse than the worse of the two.

use antumbra::encoding::depth::antumbra_look;
use antumbra::encoding::split::{antumbra_index, antumbra_room};
use antumbra::lab::cpu;
use antumbra::lab::raster::Hit;
use antumbra::{DepthSplits, Remix, Scheme, Select, ShadowFrame, ShadowTechnique, Split, Warp};

use crate::drawn::Drawn;
use crate::{Place, over_built_in, over_shared};

/// Side of each map, texels: coarse, so that neighbours differ.
const SIDE: u32 = 512;

/// Share of a slice that is blended.
const BLEND: f32 = 0.2;

/// Fewest pixels of a band that say something: of fewer, one edge decides.
const FEWEST: usize = 100;

/// Fewest bands of the built-in viewpoints: nine of them, three bands each, found in two ways.
const FEWEST_BANDS: usize = 40;

/// What f32 loses in mixing two shares of light.
const ROUNDING: f64 = 1e-6;

/// One over the width of a band that is too narrow for any point.
const HARD: f32 = 1e30;

fn splits(select: Select, blend: f32) -> Remix {
    let scheme = Scheme::Practical { lambda: 0.5, offset: 0.0 };
    let splits = DepthSplits { maps: 4, scheme, select, blend, fade: false, enough: 0.0 };
    Remix { split: Split::Depth(splits), warp: Warp::Focused, ..Remix::default() }
}

fn fit(place: &Place, remix: &Remix, side: u32) -> ShadowFrame {
    remix.fit(&place.setting.input(place.subject, &[], remix.wgsl_key(), side)).expect("a legal case")
}

/// The same maps, of which the nearer one alone answers in a band.
fn nearer(frame: &ShadowFrame) -> ShadowFrame {
    let mut hard = frame.clone();
    for view in &mut hard.uniforms.views[..frame.views.len()] {
        view.domain[3] = if frame.wgsl.select == Select::Depth { 0.0 } else { HARD };
    }
    hard
}

/// The same maps, of which the farther one alone answers in a band.
fn farther(frame: &ShadowFrame) -> ShadowFrame {
    let mut hard = nearer(frame);
    let last = frame.views.len() - 1;
    for (view, soft) in hard.uniforms.views[..last].iter_mut().zip(&frame.uniforms.views) {
        match frame.wgsl.select {
            Select::Depth if soft.domain[3] > 0.0 => view.domain[1] = soft.domain[2],
            Select::Depth => {}
            Select::Finest => view.domain[2] += soft.domain[3].recip(),
        }
    }
    hard
}

/// The map that gives way to one other at a point, if any does.
fn band(place: &Place, frame: &ShadowFrame, hit: &Hit) -> Option<usize> {
    let (key, uniforms) = (frame.wgsl, &frame.uniforms);
    let last = frame.views.len() - 1;
    if key.select == Select::Depth {
        let depth = place.setting.camera.forward().dot(hit.position) as f32;
        let index = antumbra_index(uniforms, usize::from(key.maps) - 1, depth);
        let [.., from, per_depth] = uniforms.views[index].domain;
        return (index < last && (depth - from) * per_depth > 0.0).then_some(index);
    }
    // The share that each map takes of what is left: one gives way, the next takes all of it.
    let share = |index: usize| {
        let view = &uniforms.views[index];
        let look = antumbra_look(key, view, hit.position.as_vec3(), hit.normal.as_vec3());
        antumbra_room(view, &look) * view.domain[3]
    };
    let mut held = (0..=last).map(|index| (index, share(index))).filter(|(_, share)| *share >= 0.0);
    let (first, next) = (held.next()?, held.next()?);
    (first.1 < 1.0 && next.1 >= 1.0).then_some(first.0)
}

/// Errors in a band: blended, the nearer map alone, the farther one alone; and pixels at which both alone are better.
#[derive(Default)]
struct Band {
    pixels: usize,
    sums: [f64; 3],
    worse: usize,
}

impl Band {
    fn add(&mut self, off: [f64; 3]) {
        let [blended, nearer, farther] = off;
        self.pixels += 1;
        self.sums.iter_mut().zip(off).for_each(|(sum, off)| *sum += off);
        self.worse += usize::from(!(blended <= nearer.max(farther) + ROUNDING));
    }
}

/// Looks every pixel of a band up in the same maps three times.
fn bands(place: &Place, select: Select) -> Vec<Band> {
    let drawn = Drawn::new(place.subject, &place.setting, &splits(select, BLEND), SIDE);
    let frame = &drawn.frame;
    let mut bands: Vec<Band> = frame.views.iter().map(|_| Band::default()).collect();
    if bands.len() < 2 {
        return bands;
    }
    let truth = place.truth();
    let uniforms = [frame.uniforms, nearer(frame).uniforms, farther(frame).uniforms];
    for pixel in (0..truth.valid.len()).filter(|&pixel| truth.valid[pixel]) {
        let Some(hit) = place.visible.pixel(pixel) else { continue };
        let Some(band) = band(place, frame, hit) else { continue };
        let off = uniforms.each_ref().map(|uniforms| {
            let lit = drawn.lit_by(uniforms, hit.position + place.setting.origin, hit.normal);
            f64::from((lit - truth.area[pixel]).abs())
        });
        bands[band].add(off);
    }
    bands
}

/// What was found over all cases.
#[derive(Default)]
struct Found {
    bands: usize,
    /// Bands whose mean is above both neighbours': their errors lie at different places, and the blend has some of
    /// both.
    above_both: usize,
    broken: Vec<String>,
}

/// Prints the bands of one case and notes what breaks a bound: in each pixel, and on average over all bands.
fn check(place: &Place, select: Select, found: &mut Found) {
    let (mut all, mut worse_alone) = ([0.0; 3], 0);
    for (index, Band { pixels, sums, worse }) in bands(place, select).into_iter().enumerate() {
        worse_alone += worse;
        all.iter_mut().zip(sums).for_each(|(all, sum)| *all += sum);
        if pixels < FEWEST {
            continue;
        }
        let [blended, near, far] = sums.map(|sum| sum / pixels as f64);
        let margin = near.max(far) - blended;
        println!(
            "| {} | {select:?} | {index} | {pixels} | {blended:.5} | {near:.5} | {far:.5} | {margin:+.5} |",
            place.name
        );
        found.bands += 1;
        found.above_both += usize::from(margin < -ROUNDING);
    }
    let [blended, near, far] = all;
    if worse_alone > 0 || !(blended <= near.max(far) * (1.0 + ROUNDING)) {
        let what = format!("{worse_alone} pixels worse than both, {blended} > {near}, {far} in all");
        found.broken.push(format!("{} {select:?}: {what}", place.name));
    }
}

#[test]
fn a_blend_is_no_worse_than_the_worse_of_its_maps() {
    println!("Mean |mask − area truth| in bands between maps: blended, nearer alone, farther alone; 4 maps of {SIDE}.");
    println!("| case | found by | band | pixels | blended | nearer | farther | worse − blended |");
    println!("|---|---|--:|--:|--:|--:|--:|--:|");
    let mut found = Found::default();
    let mut both = |place: &Place| {
        for select in Select::ALL {
            check(place, select, &mut found);
        }
    };
    over_built_in(&mut both);
    over_shared(&mut both);
    let Found { bands, above_both, broken } = found;
    println!("{above_both} of {bands} bands are on average worse than both of their maps.");
    assert!(bands >= FEWEST_BANDS, "{bands} bands");
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Pictures to look at: a case without and with blending, in `target/tmp`.
#[test]
fn pictures_of_seams() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    over_built_in(|place| {
        if !["treeline ahead", "sparse-city across"].contains(&place.name.as_str()) {
            return;
        }
        for select in Select::ALL {
            let pictures = [0.0, BLEND].map(|blend| {
                let frame = fit(place, &splits(select, blend), SIDE);
                let image = cpu::render(place.subject, &place.visible, &frame, &place.setting);
                let name = format!("seam {} {select:?} {blend}.png", place.name).replace(' ', "_");
                let [width, height] = place.case.viewport;
                image::save_buffer(folder.join(name), &image.mask, width, height, image::ColorType::L8)
                    .expect("a writable folder");
                image.mask
            });
            assert_ne!(pictures[0], pictures[1], "{} {select:?}: blending changes nothing", place.name);
        }
    });
}
