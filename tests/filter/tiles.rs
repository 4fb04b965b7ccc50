//! Maps that share a layer: filtered without touching each other, and read without reading each other.

use antumbra::encoding::depth::CompareMap;
use antumbra::encoding::split::OnMap;
use antumbra::gpu::{ShadowMaps, wgpu};
use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::gpu::{Renderer, read_moments};
use antumbra::lab::subject::{Setting, Subject};
use antumbra::{DepthRange, Light, MomentFormat, MomentKind, Moments, Radius, ShadowFrame, Why};
use glam::{DVec3, UVec2};

use crate::stage::{SIZE, Stage, encoding, filtered, fit, fit_to, kinds, tiled};
use crate::support;

/// Side of a layer, texels: the smallest tiles are 32.
const SIDE: u32 = 256;

/// Moments that are read in all ways there are.
fn ways() -> impl Iterator<Item = Moments> {
    let others =
        [(MomentKind::Variance, MomentFormat::Float16), (MomentKind::ExponentialVarianceFour, MomentFormat::Float16)];
    kinds().chain(others.map(|(kind, format)| Moments::new(kind, format)))
}

/// The same views, a layer for each.
fn apart(frame: &ShadowFrame) -> ShadowFrame {
    let mut apart = frame.clone();
    for index in 0..apart.views.len() {
        apart.views[index].layer = index as u32;
        apart.uniforms.views[index].across_u[3] = index as f32;
    }
    apart.map.layers = apart.views.len() as u32;
    apart
}

/// Filters a frame whose maps are drawn.
pub(crate) fn filter(stage: &Stage, frame: &ShadowFrame, maps: &ShadowMaps) {
    maps.prepare(stage.gpu.queue(), frame).unwrap();
    let mut encoder = stage.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    maps.filter(&mut encoder, frame, &mut |_, _| None);
    stage.gpu.queue().submit([encoder.finish()]);
}

/// Filtering one view anew, wider, changes no texel outside of its tile.
#[test]
fn filters_leave_neighbours_alone() {
    let Some(stage) = Stage::new() else { return };
    for moments in ways() {
        let (remix, map) = tiled(encoding(moments, Radius::Texels(1.5), false), SIDE);
        let frame = fit(&remix, map);
        let maps = stage.maps(&frame);
        stage.draw(&Renderer::new(&stage.gpu, frame.wgsl), &frame, &maps);
        let layers = frame.map.layers * moments.layers();
        let read = |layer| read_moments(&stage.gpu, &maps, layer, 0).unwrap();
        let mut before: Vec<_> = (0..layers).map(read).collect();
        for view in frame.views.iter().filter(|view| view.blur.tile[2] < SIDE) {
            let mut one = frame.clone();
            one.views.clear();
            one.views.push(view.clone());
            one.views[0].blur.radius = -9.0;
            filter(&stage, &one, &maps);
            let mut changed = 0;
            let [left, top, side, _] = view.blur.tile;
            for layer in 0..layers {
                let after = read(layer);
                for (index, (now, then)) in after.iter().zip(&before[layer as usize]).enumerate() {
                    let [x, y] = [index as u32 % SIDE, index as u32 / SIDE];
                    let within = (left..left + side).contains(&x) && (top..top + side).contains(&y);
                    let same = now.to_array().map(f32::to_bits) == then.to_array().map(f32::to_bits);
                    if within && layer / moments.layers() == view.layer {
                        changed += usize::from(!same);
                    } else {
                        assert!(same, "{moments:?}: texel {x}, {y} of layer {layer}, beside {:?}", view.blur.tile);
                    }
                }
                before[layer as usize] = after;
            }
            assert!(changed > 20, "{moments:?}: {changed} texels changed in {:?}", view.blur.tile);
        }
    }
}

/// Maps in one layer and maps in layers of their own give one picture, bit by bit, with mips and without: large maps,
/// which are read from small levels.
#[test]
fn tiles_are_layers() {
    let Some(stage) = Stage::new() else { return };
    for moments in ways() {
        for side in [1024, 1000] {
            let pictures = [false, true].map(|mips| {
                let moments = moments.read(moments.linear, mips);
                let (remix, map) = tiled(encoding(moments, Radius::Texels(1.5), false), side);
                let frame = fit(&remix, map);
                let (together, alone) = (stage.picture(&frame), stage.picture(&apart(&frame)));
                let differ = together.iter().zip(&alone).filter(|(a, b)| a != b).count();
                let most = together.iter().zip(&alone).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(differ == 0, "{moments:?}, side {side}: {differ} pixels by {most:?}");
                assert!(together.iter().any(|lit| *lit < 40) && together.contains(&255), "{moments:?}");
                together
            });
            let differ = pictures[0].iter().zip(&pictures[1]).filter(|(a, b)| a != b).count();
            println!("{} {}, side {side}: mips change {differ} pixels", moments.kind().name(), moments.format().name());
            assert!(differ > 100, "{moments:?}, side {side}: {differ} pixels");
        }
    }
}

/// Read from small levels of shared layers, the picture is the software renderer's.
#[test]
fn levels_are_read_as_in_memory() {
    let Some(stage) = Stage::new() else { return };
    let (camera, origin) = (support::camera(SIZE), DVec3::ZERO);
    let (light, subject) = (Light::Directional { travel: support::travel() }, Subject::new(support::boxes()));
    let setting = Setting { camera, light, visible: DepthRange { near: 0.0, far: 100.0 }, origin };
    let visible = Visible::draw(&subject.model, &camera, origin);
    for moments in ways().map(|moments| moments.read(moments.linear, true)) {
        let (remix, map) = tiled(encoding(moments, Radius::Texels(1.5), false), 1024);
        let frame = fit(&remix, map);
        let (gpu, software) = (stage.picture(&frame), cpu::render(&subject, &visible, &frame, &setting).mask);
        let differ = gpu.iter().zip(&software).filter(|(gpu, cpu)| gpu.abs_diff(**cpu) > 8).count();
        println!("{} {}: {differ} of {} pixels differ", moments.kind().name(), moments.format().name(), gpu.len());
        // Camera edges that rasterisers put into different pixels.
        assert!(differ * 200 < gpu.len(), "{moments:?}: {differ} pixels");
    }
}

/// Whatever neighbours hold, no level of a tile reads it: all of them near casters, or none.
#[test]
fn neighbours_are_not_read() {
    for moments in ways().map(|moments| moments.read(moments.linear, true)) {
        for side in [SIDE, 250] {
            let (remix, map) = tiled(encoding(moments, Radius::Texels(3.0), false), side);
            let frame = fit(&remix, map);
            let mut checked = [0; 8];
            for (index, view) in frame.views.iter().enumerate() {
                let [left, top, tile, _] = view.blur.tile;
                let layer = |beside: f32| -> Vec<f32> {
                    (0..side * side)
                        .map(|texel| {
                            let [x, y] = [texel % side, texel / side];
                            let within = (left..left + tile).contains(&x) && (top..top + tile).contains(&y);
                            if within { 0.5 + 0.001 * (x % 7) as f32 } else { beside }
                        })
                        .collect()
                };
                // All views of the layer are filtered.
                let depths = |beside| (0..frame.map.layers).map(|_| layer(beside)).collect::<Vec<_>>();
                let [near, far] = [0.0, 1.0].map(|beside| filtered(moments, &frame, &depths(beside)));
                let uniforms = &frame.uniforms.views[index];
                let key = frame.wgsl;
                let [low_u, low_v, high_u, high_v] = uniforms.rect;
                for step in 0..=40 {
                    let share = step as f32 / 40.0;
                    let [u, v] = [low_u + share * (high_u - low_u), low_v + share * (high_v - low_v)];
                    for uv in [[low_u, v], [high_u, v], [u, low_v], [u, high_v], [u, v], [-1.0, v], [u, 2.0]] {
                        let mut level = 0.0;
                        while level <= uniforms.moments[1] {
                            let read = |maps: &[_]| {
                                let map = OnMap::of(uniforms, maps).unwrap();
                                map.stored(uv.into(), level, 0)
                            };
                            assert_eq!(
                                read(&near),
                                read(&far),
                                "{moments:?}, {uv:?} of level {level}, view {index}, {key:?}"
                            );
                            checked[index] += 1;
                            level += 0.375;
                        }
                    }
                }
            }
            assert!(checked.iter().filter(|checked| **checked > 200).count() >= 4, "{checked:?}");
        }
    }
}

/// Levels that a tile is read from are those in which it is whole texels.
#[test]
fn levels_end_where_tiles_do() {
    let mut ended = 0;
    for side in [SIDE, 512, 250, 1000, 100] {
        let moments = Moments::new(MomentKind::Variance, MomentFormat::Float16).read(true, true);
        let (remix, map) = tiled(encoding(moments, Radius::Texels(1.5), false), side);
        // A picture of few pixels, which see many texels.
        let frame = fit_to(&remix, support::camera(UVec2::new(4, 3)), map);
        for (view, uniforms) in frame.views.iter().zip(&frame.uniforms.views) {
            let [left, top, tile, of] = view.blur.tile;
            let last = uniforms.moments[1] as u32;
            assert_eq!(uniforms.moments[1], last as f32);
            let is_whole = |level: u32| [left, top, tile, of].iter().all(|length| length % (1 << level) == 0);
            // Whole maps as well: half of an odd side is not where it is looked up.
            assert!(is_whole(last), "{last}: {:?}", view.blur.tile);
            assert!(last == moments.last_level(side) || !is_whole(last + 1), "{last}: {:?}", view.blur.tile);
            ended += usize::from(last < moments.last_level(side));
            let said =
                frame.left_out.iter().any(|cut| matches!(cut.why, Why::SidesAreOdd { halved, .. } if halved == last));
            assert_eq!(said, last < moments.last_level(side), "{:?}", view.blur.tile);
        }
    }
    assert!(ended > 4, "{ended}");
}
