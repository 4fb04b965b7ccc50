//! Several maps: which of them a receiver reads, and how neighbours are blended.

use antumbra::encoding::depth::DepthMap;
use antumbra::encoding::split::{OnMap, antumbra_index, antumbra_room, antumbra_visibility_noisy};
use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::gpu::{Gpu, read_depth};
use antumbra::wgsl::{self, Bindings};
use antumbra::{MapBudget, MapShape, Pcf, Select, ShadowFrame, Texel, ViewUniforms, WgslKey};
use bytemuck::{Pod, Zeroable};
use glam::{UVec2, Vec3, Vec4};

use crate::cases::{frame, noise};
use crate::check::{Doubt, WEIGHT_TOLERANCE};
use crate::dice::Dice;
use crate::rounded::ULP;
use crate::support::compute::compute;
use crate::{adapter, support};

/// Maps of every key here.
const MAPS: u8 = 4;

/// Side of each, texels.
const SIDE: u32 = 64;

/// Cases of each key.
const CASES: usize = 8_192;

/// Eye depths go up to here, world units: half as far again as the last view serves.
const FARTHEST: f32 = 18.0;

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Case {
    position: Vec4,
    normal: Vec4,
}

#[test]
fn twins_agree_on_several_maps() {
    let Some(gpu) = support::gpu() else { return };
    for shape in MapShape::ALL {
        for (select, blend) in Select::ALL.into_iter().flat_map(|select| [(select, false), (select, true)]) {
            for filter in [Pcf::Hardware2x2, Pcf::Box3x3, Pcf::Pixel, Pcf::Disc, Pcf::Pcss] {
                let key =
                    WgslKey { texel: Texel::Depth, filter, shape, maps: MAPS, select, blend, ..WgslKey::default() };
                // All maps in use, and one left over.
                for views in [MAPS, MAPS - 1] {
                    let tally = compare(&gpu, key, views.into());
                    eprintln!("{key:?}, {views} views ({CASES} cases, {}): {tally:?}", gpu.adapter());
                }
            }
        }
    }
}

/// What was seen, for the record.
#[derive(Debug, Default)]
struct Tally {
    /// Largest difference beyond doubt.
    worst: f32,
    /// Cases in which a comparison was in doubt.
    doubtful: usize,
    /// Cases that each map answered, alone or with others; the last figure is of those that none did.
    served: [usize; MAPS as usize + 1],
    /// Cases that are neither lit nor dark.
    between: usize,
}

fn compare(gpu: &Gpu, key: WgslKey, views: usize) -> Tally {
    // Maps of noise, and a view of each.
    let mut dice = Dice::new(0x5EED_0F3A ^ (key.shape as u64) << 8 ^ views as u64);
    let frame = several(&mut dice, key, views);
    let depths: Vec<Vec<f32>> = (0..views).map(|_| (0..SIDE * SIDE).map(|_| noise(&mut dice)).collect()).collect();
    let maps = ShadowMaps::new(gpu.device(), &ShadowMapsDescriptor { label: None, key, map: frame.map }).unwrap();
    maps.prepare(gpu.queue(), &frame).unwrap();
    for view in &frame.views {
        adapter::fill(gpu, &maps, view, &depths[view.layer as usize]);
    }
    for (layer, depth) in depths.iter().enumerate() {
        assert_eq!(&read_depth(gpu, &maps, layer as u32).unwrap(), depth, "layer {layer} is its own");
    }
    // Run both.
    let cases: Vec<Case> = (0..CASES).map(|_| case(&mut dice, &frame)).collect();
    let call = if key.filter.is_disc() {
        "return antumbra_visibility_noisy(position, normal, view_depth, noise);"
    } else {
        "return antumbra_visibility(position, normal, view_depth);"
    };
    let call =
        format!("fn visibility(position: vec3f, normal: vec3f, view_depth: f32, noise: f32) -> f32 {{ {call} }}");
    let library = wgsl::module(key, Bindings { group: 1, first: 0 });
    let text = [library.as_str(), include_str!("many.wgsl"), &call].join("\n");
    let found: Vec<f32> = compute(gpu, &text, &cases, &maps.bind_entries(0));
    let maps: Vec<_> = depths.iter().map(|depth| DepthMap { size: UVec2::splat(SIDE), depth }).collect();
    let mut tally = Tally::default();
    for (case, shader) in cases.iter().zip(found) {
        check(&frame, &maps, case, shader, &mut tally);
    }
    // Each map has its part, and doubt is not all there is.
    assert!(tally.served[..views].iter().all(|served| served * 40 > CASES), "{key:?}: {tally:?}");
    let all_are_served = key.select == Select::Depth && views == usize::from(MAPS);
    assert!(all_are_served || tally.served[MAPS as usize] * 100 > CASES, "{key:?}: {tally:?}");
    assert!(tally.doubtful * 3 < CASES && tally.between * 20 > CASES, "{key:?}: {tally:?}");
    tally
}

/// A frame of several views of a box of ten units, each with a domain of depths and a rectangle of its own: the nearest
/// is the smallest.
fn several(dice: &mut Dice, key: WgslKey, views: usize) -> ShadowFrame {
    // Wide borders would leave next to nothing of maps as small as these.
    let filter = if key.filter.is_disc() { Pcf::Hardware2x2 } else { key.filter };
    let one = WgslKey { filter, shape: key.shape, ..WgslKey::default() };
    let mut whole = frame(dice, one, SIDE, 0);
    let layers = u32::from(MAPS);
    (whole.wgsl, whole.map) = (key, MapBudget { side: SIDE, layers, views: layers });
    let first = whole.views[0].clone();
    whole.views.clear();
    whole.uniforms.views = [ViewUniforms::LIT; antumbra::MAX_VIEWS];
    for index in 0..views {
        let fitted = frame(dice, one, SIDE, index);
        let mut view = first.clone();
        // Layers are not in the order of views.
        view.layer = (views - 1 - index) as u32;
        whole.views.push(view);
        whole.uniforms.views[index] = placed(dice, key, &fitted.uniforms.views[0], index);
        whole.uniforms.views[index].across_u[3] = (views - 1 - index) as f32;
    }
    // The end of all maps, within the depths of cases.
    let first = &mut whole.uniforms.views[0];
    (first.across_v[3], first.across_w[3]) = (0.6 * FARTHEST, 4.0 / FARTHEST);
    whole
}

fn placed(dice: &mut Dice, key: WgslKey, view: &ViewUniforms, index: usize) -> ViewUniforms {
    let mut view = *view;
    // A part of the layer, beyond which its rim is read.
    let half = [0.12, 0.22, 0.31, 0.44][index.min(3)];
    let [u, v] = [dice.single(0.47, 0.53), dice.single(0.47, 0.53)];
    view.rect = [u - half, v - half, u + half, v + half];
    if key.filter == Pcf::Pcss {
        // World units of radius a unit of depth, some ten texels; and the most that the filter reaches.
        view.moments = [2.0, 16.0, 0.0, 0.0];
    }
    match key.select {
        Select::Depth => {
            let (near, far) = (3.0 * index as f32, 3.0 * (index + 1) as f32);
            let band = dice.single(0.5, 2.0);
            view.domain = [near, far, far - band, if key.blend { 1.0 / band } else { 0.0 }];
        }
        Select::Finest => {
            view.domain[2] = dice.single(0.0, 1.0) * view.bias[3];
            view.domain[3] = 1.0 / dice.single(0.05, 0.2);
        }
    }
    view
}

fn case(dice: &mut Dice, frame: &ShadowFrame) -> Case {
    let domain = frame.uniforms.views[dice.below(frame.views.len())].domain;
    let eye_depth = match dice.below(16) {
        // Exactly where a view ends, and where it begins to give way.
        0 => domain[1],
        1 => domain[2],
        2 => dice.single(-1e6, 1e6),
        _ => dice.single(0.0, FARTHEST),
    };
    let position = if dice.below(8) == 0 { dice.vector(50.0) } else { dice.vector(5.0) };
    let normal = if dice.below(8) == 0 { Vec3::ZERO } else { dice.vector(1.0).normalize_or(Vec3::Y) };
    let noise = (7.3 * position.x).rem_euclid(1.0);
    Case { position: position.extend(eye_depth), normal: normal.extend(noise) }
}

fn check(frame: &ShadowFrame, maps: &[DepthMap], case: &Case, shader: f32, tally: &mut Tally) {
    assert!((0.0..=1.0 + WEIGHT_TOLERANCE).contains(&shader), "{shader} is no share: {case:?}");
    // Which maps are read, and whether rounding may change what they say.
    let Some(read) = consulted(frame, case) else {
        tally.doubtful += 1;
        return;
    };
    let (key, (position, normal)) = (frame.wgsl, (case.position.truncate(), case.normal.truncate()));
    let is_doubtful = |&index: &usize| {
        let Some(map) = OnMap::of(&frame.uniforms.views[index], maps).filter(|_| index < maps.len()) else {
            return false;
        };
        let Some(doubt) = Doubt::of(key, &frame.uniforms.views[index], position, normal, case.normal.w) else {
            return true;
        };
        let (low, high) = doubt.band(key.filter, &map);
        doubt.is_wide(&map) || high - low > WEIGHT_TOLERANCE
    };
    if read.iter().any(is_doubtful) {
        tally.doubtful += 1;
        return;
    }
    let twin = antumbra_visibility_noisy(key, &frame.uniforms, maps, position, normal, case.position.w, case.normal.w);
    let difference = (shader - twin).abs();
    assert!(difference <= 2.0 * WEIGHT_TOLERANCE, "{key:?}: {shader} and {twin}, of {read:?}: {case:?}");
    tally.worst = tally.worst.max(difference);
    tally.between += usize::from(twin > 0.01 && twin < 0.99);
    let served: Vec<usize> = read.into_iter().filter(|index| *index < maps.len()).collect();
    for index in &served {
        tally.served[*index] += 1;
    }
    tally.served[MAPS as usize] += usize::from(served.is_empty());
}

/// The maps that an answer depends on; `None` where rounding decides about it.
fn consulted(frame: &ShadowFrame, case: &Case) -> Option<Vec<usize>> {
    let (key, uniforms, last) = (frame.wgsl, &frame.uniforms, usize::from(MAPS) - 1);
    let (position, normal) = (case.position.truncate(), case.normal.truncate());
    if key.select == Select::Depth {
        // Depths are compared as they are given: beyond doubt.
        let index = antumbra_index(uniforms, last, case.position.w);
        return Some(if key.blend { vec![index, index + 1] } else { vec![index] });
    }
    let mut read = Vec::new();
    for (index, view) in uniforms.views[..frame.views.len()].iter().enumerate() {
        let doubt = Doubt::of(key, view, position, normal, case.normal.w)?;
        let room = f64::from(antumbra_room(view, &doubt.look));
        let slack = doubt.uv[0].max(doubt.uv[1]) + 8.0 * ULP;
        if room.abs() <= slack || (f64::from(doubt.look.depth) - 1.0).abs() <= doubt.depth {
            return None;
        }
        // Shares along a rim move with the place.
        if key.blend && slack * f64::from(view.domain[3]) > f64::from(WEIGHT_TOLERANCE) {
            return None;
        }
        if room > 0.0 {
            read.push(index);
            if !key.blend || room * f64::from(view.domain[3]) > 1.0 + slack * f64::from(view.domain[3]) {
                break;
            }
        }
    }
    Some(read)
}
