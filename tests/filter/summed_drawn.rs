//! Summed-area tables on an adapter: the passes against memory, in tiles and beside them, and what is drawn with them.

use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::gpu::{GpuScene, RenderOptions, Renderer, read_depth, read_sums};
use antumbra::lab::subject::{Setting, Subject};
use antumbra::{DepthRange, Light, MapBudget, MomentFormat, MomentKind, Moments, Radius, Remix, techniques};
use glam::{DVec3, UVec2};

use crate::poison::hostile;
use crate::stage::{SIZE, Stage, encoding, fit, tiled};
use crate::summed::{counted, places, summed, texel};
use crate::support;
use crate::tiles::filter;

/// and every sum is that of its texels, exactly; one map, sides that are no powers of eight among them, and tiles.
#[test]
fn passes_agree_with_memory() {
    let Some(stage) = Stage::new() else { return };
    for moments in summed() {
        let encoding = encoding(moments, Radius::Texels(1.5), false);
        let one = |side| (Remix { encoding, ..techniques::tsm() }, MapBudget::one(side));
        for (remix, map) in [one(7), one(64), one(130), one(520), tiled(encoding, 128)] {
            let frame = fit(&remix, map);
            let maps = stage.maps(&frame);
            stage.draw(&Renderer::new(&stage.gpu, frame.wgsl), &frame, &maps);
            for view in &frame.views {
                let depths = read_depth(&stage.gpu, &maps, view.layer).unwrap();
                let sums = read_sums(&stage.gpu, &maps, view.layer).unwrap();
                let [left, top, tile, side] = view.blur.tile;
                for at in places(tile).map(|at| at + UVec2::new(left, top)) {
                    let found = texel(&sums, side, view, at);
                    let expected = counted(moments, depths[(at.y * side + at.x) as usize]);
                    let off = found.as_i64vec4() - expected.as_i64vec4();
                    assert!(off.abs().max_element() <= 1, "{moments:?} at {at} of {:?}: {off}", view.blur.tile);
                }
            }
        }
    }
}

/// too: of the same half-width, in texels and in the world, one map and tiles, warped and not.
#[test]
fn pictures_are_those_of_the_blur() {
    let Some(stage) = Stage::new() else { return };
    for kind in [MomentKind::Variance, MomentKind::Hamburger, MomentKind::Hausdorff] {
        for (name, radius) in [
            ("1.5 texels", Radius::Texels(1.5)),
            ("8.5 texels", Radius::Texels(8.5)),
            ("0.2 of the world", Radius::World(0.2)),
        ] {
            let picture = |format| {
                let encoding = encoding(Moments::new(kind, format).read(false, false), radius, false);
                let one = Remix { encoding, guard: false, ..techniques::tsm() };
                let (many, map) = tiled(encoding, 512);
                [stage.picture(&fit(&one, MapBudget::one(512))), stage.picture(&fit(&many, map))].concat()
            };
            let (summed, blurred) = (picture(MomentFormat::Summed), picture(MomentFormat::Float32));
            let off = || summed.iter().zip(&blurred).map(|(a, b)| a.abs_diff(*b));
            let mean = off().map(f64::from).sum::<f64>() / summed.len() as f64;
            println!("{}, {name}: mean difference {mean:.3} of 255, most {:?}", kind.name(), off().max());
            // What sixteen bits change of four moments, as for maps that are blurred in them (formats.rs); of variance
            // less than samplers do.
            let most = if kind == MomentKind::Variance { 0.25 } else { 1.0 };
            assert!(mean <= most, "{kind:?}, {name}: {mean}");
            assert!(summed.iter().any(|lit| *lit < 60) && summed.contains(&255), "{kind:?}");
        }
    }
}

/// The picture of an adapter is the software renderer's.
#[test]
fn pictures_agree_with_memory() {
    let Some(stage) = Stage::new() else { return };
    let (camera, origin) = (support::camera(SIZE), DVec3::ZERO);
    let (light, subject) = (Light::Directional { travel: support::travel() }, Subject::new(support::boxes()));
    let setting = Setting { camera, light, visible: DepthRange { near: 0.0, far: 100.0 }, origin };
    let visible = Visible::draw(&subject.model, &camera, origin);
    for moments in summed() {
        for radius in [Radius::Texels(0.0), Radius::Texels(3.3), Radius::Texels(100.0), Radius::World(0.3)] {
            let encoding = encoding(moments, radius, false);
            let one = (Remix { encoding, guard: false, ..techniques::lispsm() }, MapBudget::one(512));
            for (remix, map) in [one, tiled(encoding, 512)] {
                let frame = fit(&remix, map);
                let (gpu, software) = (stage.picture(&frame), cpu::render(&subject, &visible, &frame, &setting).mask);
                let differ = gpu.iter().zip(&software).filter(|(gpu, cpu)| gpu.abs_diff(**cpu) > 8).count();
                println!("{}, {radius:?}: {differ} of {} pixels differ", moments.kind().name(), gpu.len());
                // Camera edges that rasterisers put into different pixels.
                assert!(differ * 200 < gpu.len(), "{moments:?}, {radius:?}: {differ} pixels");
            }
        }
    }
}

/// On the adapter too: summing one view anew changes no texel outside of its tile, and its own to what they were.
#[test]
fn sums_leave_neighbours_alone() {
    let Some(stage) = Stage::new() else { return };
    for moments in summed() {
        let (remix, map) = tiled(encoding(moments, Radius::Texels(1.5), false), 256);
        let frame = fit(&remix, map);
        let maps = stage.maps(&frame);
        let renderer = Renderer::new(&stage.gpu, frame.wgsl);
        stage.draw(&renderer, &frame, &maps);
        let read = || (0..frame.map.layers).map(|layer| read_sums(&stage.gpu, &maps, layer).unwrap());
        let before: Vec<_> = read().collect();
        for view in frame.views.iter().filter(|view| view.blur.tile[2] < 256) {
            let mut one = frame.clone();
            one.views.clear();
            one.views.push(view.clone());
            // As if the tile began a texel later: other sums.
            one.views[0].blur.tile[0] += 1;
            one.views[0].blur.tile[1] += 1;
            one.views[0].blur.tile[2] -= 1;
            let [left, top, side, _] = one.views[0].blur.tile;
            filter(&stage, &one, &maps);
            let mut changed = 0;
            for (layer, (now, then)) in read().zip(&before).enumerate() {
                for (index, (now, then)) in now.iter().zip(then).enumerate() {
                    let [x, y] = [index as u32 % 256, index as u32 / 256];
                    let within = (left..left + side).contains(&x) && (top..top + side).contains(&y);
                    assert!(now == then || (within && layer as u32 == view.layer), "{moments:?}: {x}, {y} of {layer}");
                    changed += usize::from(now != then);
                }
            }
            assert!(changed > 20, "{changed}");
            filter(&stage, &frame, &maps);
            assert!(read().eq(before.iter().cloned()), "{moments:?}: not what it was");
        }
    }
}

/// On the adapter: casters with vertices that are none change no picture.
#[test]
fn hostile_casters_change_nothing() {
    let Some(stage) = Stage::new() else { return };
    let scene = GpuScene::upload(&stage.gpu, &hostile(), DVec3::ZERO).unwrap();
    for moments in summed() {
        let remix = Remix { encoding: encoding(moments, Radius::Texels(3.0), false), ..techniques::fsm() };
        let frame = fit(&remix, MapBudget::one(256));
        let (maps, renderer) = (stage.maps(&frame), Renderer::new(&stage.gpu, frame.wgsl));
        let clean = stage.draw(&renderer, &frame, &maps);
        let (camera, options) = (support::camera(SIZE), RenderOptions::default());
        let picture = renderer.render(&stage.gpu, &scene, &camera, &frame, &maps, &options).unwrap().mask;
        assert!(clean == picture && clean.iter().any(|lit| *lit < 40), "{moments:?}");
    }
}
