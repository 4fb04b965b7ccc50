//! Several maps: drawn layer by layer, and read by eye depth or by what holds a point. The frames are put together
//! here, from fits of one map each.

use antumbra::gpu::{GpuError, ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::gpu::{RenderOptions, Renderer, read_depth};
use antumbra::lab::raster::Hit;
use antumbra::lab::serving::serving;
use antumbra::lab::subject::{Setting, Subject};
use antumbra::warp::Warp;
use antumbra::{
    Camera, DepthLaw, DepthRange, FitInput, Light, MapBudget, Projection, Remix, Scene, Select, ShadowFrame,
    ShadowTechnique, ViewUniforms, WgslKey, techniques,
};
use glam::DVec3;

use crate::{SIZE, Stage, support, wrong_in_the_interior};

/// Side of each map, texels.
const SIDE: u32 = 512;

/// Eye depth that divides the scene, which lies between 4 and 28.
const MIDDLE: f64 = 14.0;

/// Eye depths before it in which views are blended.
const BAND: f64 = 3.0;

/// Uniform, warped, and warped with casters that need no fragments.
fn shapes() -> [Remix; 3] {
    let strength = Remix { warp: Warp::Fixed { strength: 0.5 }, ..Remix::default() };
    [techniques::fsm(), strength, Remix { depth: DepthLaw::Projective, ..strength }]
}

/// The ways to find a map among several.
fn ways() -> impl Iterator<Item = (Select, bool)> {
    Select::ALL.into_iter().flat_map(|select| [(select, false), (select, true)])
}

/// A map of the eye depths from `near` to `far`.
fn part(stage: &Stage, technique: &Remix, camera: Camera, [near, far]: [f64; 2]) -> ShadowFrame {
    let scene = Scene { visible_depth: Some(DepthRange { near, far }), ..Scene::within(support::bounds(&stage.model)) };
    let light = Light::Directional { travel: support::travel() };
    technique
        .fit(&FitInput { camera, light, scene, map: MapBudget::one(SIDE), origin: stage.origin, previous: None })
        .unwrap()
}

/// The two parts that [`several`] puts together.
fn parts(stage: &Stage, technique: &Remix, camera: Camera, select: Select) -> [ShadowFrame; 2] {
    // By containment, nothing tells the second map where it is wanted.
    let from = if select == Select::Depth { MIDDLE - BAND } else { 0.0 };
    [[0.0, MIDDLE], [from, 100.0]].map(|depths| part(stage, technique, camera, depths))
}

/// Two views in one frame, for a shader of `maps` maps.
fn several(parts: &[ShadowFrame; 2], maps: u8, (select, blend): (Select, bool)) -> ShadowFrame {
    let mut frame = parts[0].clone();
    let second = &parts[1];
    frame.wgsl = WgslKey { maps, select, blend, ..frame.wgsl };
    frame.map = MapBudget { side: SIDE, layers: maps.into(), views: maps.into() };
    frame.views.push(second.views[0].clone());
    frame.views[1].layer = 1;
    frame.uniforms.views[1] = second.uniforms.views[0];
    frame.uniforms.views[1].across_u[3] = 1.0;
    let band = if blend { 1.0 / BAND as f32 } else { 0.0 };
    let [first, last] = match select {
        Select::Depth => [[0.0, MIDDLE as f32, (MIDDLE - BAND) as f32, band], [MIDDLE as f32, f32::MAX, f32::MAX, 0.0]],
        // A twentieth of the map along its rim.
        Select::Finest => [[0.0, 0.0, 0.0, 20.0]; 2],
    };
    (frame.uniforms.views[0].domain, frame.uniforms.views[1].domain) = (first, last);
    frame
}

fn maps_of(stage: &Stage, frame: &ShadowFrame) -> ShadowMaps {
    let descriptor = ShadowMapsDescriptor { label: Some("several"), key: frame.wgsl, map: frame.map };
    ShadowMaps::new(stage.gpu.device(), &descriptor).unwrap()
}

fn draw(stage: &Stage, camera: Camera, frame: &ShadowFrame) -> (Vec<u8>, ShadowMaps) {
    let maps = maps_of(stage, frame);
    let renderer = Renderer::new(&stage.gpu, frame.wgsl);
    let options = RenderOptions { repetitions: 3 };
    let image = renderer.render(&stage.gpu, &stage.scene, &camera, frame, &maps, &options).unwrap();
    assert!(image.timings.casters_ms > 0.0 && image.timings.receivers_ms > 0.0, "{:?}", image.timings);
    (image.mask, maps)
}

fn setting(stage: &Stage, camera: Camera) -> Setting {
    let light = Light::Directional { travel: support::travel() };
    Setting { camera, light, visible: DepthRange { near: 0.0, far: 100.0 }, origin: stage.origin }
}

/// Every shape, every way: away from edges the picture is the rays' picture, from either renderer.
#[test]
fn several_maps_show_what_rays_say() {
    let Some(stage) = Stage::new(DVec3::new(3.0, -2.0, 5.0)) else { return };
    let subject = Subject::new(stage.model.clone());
    let base = support::camera(SIZE);
    let orthographic = Projection::Orthographic { left: -6.0, right: 8.0, down: -5.0, up: 5.5, near: 0.5, far: 40.0 };
    for camera in [base, Camera { projection: orthographic, ..base }] {
        let setting = setting(&stage, camera);
        let visible = Visible::draw(&stage.model, &camera, stage.origin);
        for technique in shapes() {
            for way in ways() {
                let frame = several(&parts(&stage, &technique, camera, way.0), 2, way);
                let (mask, maps) = draw(&stage, camera, &frame);
                let (wrong, counted) = wrong_in_the_interior(&stage.model, &camera, &mask);
                let software = cpu::render(&subject, &visible, &frame, &setting).mask;
                let differ = mask.iter().zip(&software).filter(|(gpu, cpu)| gpu.abs_diff(**cpu) > 16).count();
                eprintln!("{:?}: {wrong} of {counted} wrong, {differ} differ", frame.wgsl);
                assert!(counted > 50_000 && wrong * 2_000 < counted, "{:?}: {wrong} of {counted}", frame.wgsl);
                assert!(differ * 500 < mask.len(), "{:?}: {differ} pixels differ", frame.wgsl);
                // Both are needed: with the first map alone, or the second, something is missing.
                let served = [0, 1].map(|view| {
                    let serves =
                        |hit: &&Hit| serving(&frame, &camera, stage.origin, hit.position, hit.normal) == Some(view);
                    visible.iter().filter(serves).count()
                });
                assert!(served.iter().all(|count| count * 10 > visible.iter().count()), "{served:?}");
                assert_eq!(maps.bytes(), 2 * 4 * u64::from(SIDE * SIDE));
            }
        }
    }
}

/// Each layer holds what a map of its own would hold, bit by bit; a frame of fewer views than maps is the same picture,
/// whether or not there are layers for the others.
#[test]
fn layers_are_maps() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(SIZE);
    for technique in shapes() {
        for way in ways() {
            let parts = parts(&stage, &technique, camera, way.0);
            let frame = several(&parts, 2, way);
            let (mask, maps) = draw(&stage, camera, &frame);
            let layers = [0, 1].map(|layer| read_depth(&stage.gpu, &maps, layer).unwrap());
            let alone = parts.each_ref().map(|part| {
                let (_, map) = draw(&stage, camera, part);
                read_depth(&stage.gpu, &map, 0).unwrap()
            });
            assert!(layers == alone && layers[0] != layers[1], "{:?}", frame.wgsl);
            let more = several(&parts, 4, way);
            let mut fewer_layers = more.clone();
            fewer_layers.map.layers = 2;
            for frame in [&more, &fewer_layers] {
                let (same, maps) = draw(&stage, camera, frame);
                assert_eq!(maps.layers(), frame.map.layers);
                assert!(same == mask, "{:?}", frame.wgsl);
            }
        }
    }
}

/// Behind the last view there is light, and so there is without any view, whatever the layers hold.
#[test]
fn unused_maps_read_lit() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(SIZE);
    let visible = Visible::draw(&stage.model, &camera, stage.origin);
    let end = MIDDLE + 1.0;
    // Beyond doubt: adapters interpolate positions.
    let is_behind = |hit: &Hit| (hit.position + stage.origin - camera.eye()).dot(camera.forward()) > end + 1e-3;
    for technique in shapes() {
        for blend in [false, true] {
            // The second view ends within the scene; two more are not in use.
            let mut frame = several(&parts(&stage, &technique, camera, Select::Depth), 4, (Select::Depth, blend));
            frame.uniforms.views[1].domain[1] = end as f32;
            let (mask, maps) = draw(&stage, camera, &frame);
            let (mut behind, mut dark) = (0, 0);
            for (pixel, lit) in mask.iter().enumerate() {
                if visible.pixel(pixel).is_none_or(is_behind) {
                    behind += usize::from(visible.pixel(pixel).is_some());
                    assert_eq!(*lit, 255, "{:?}, pixel {pixel}", frame.wgsl);
                }
                dark += usize::from(*lit == 0);
            }
            assert!(behind > 5_000 && dark > 2_000, "{behind} behind, {dark} dark");
            // The same maps, drawn as they are, under a frame without views.
            let renderer = Renderer::new(&stage.gpu, frame.wgsl);
            frame.views.clear();
            frame.uniforms.views = [ViewUniforms::LIT; antumbra::MAX_VIEWS];
            let options = RenderOptions::default();
            let image = renderer.render(&stage.gpu, &stage.scene, &camera, &frame, &maps, &options).unwrap();
            assert!(image.mask.iter().all(|lit| *lit == 255), "{:?}", frame.wgsl);
        }
    }
}

/// What does not fit several maps is refused, with both sides named; races are run over all views.
#[test]
fn several_maps_refuse_misfits() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(SIZE);
    let frame = several(&parts(&stage, &techniques::fsm(), camera, Select::Depth), 2, (Select::Depth, false));
    let maps = maps_of(&stage, &frame);
    let refused = |frame: &ShadowFrame| maps.prepare(stage.gpu.queue(), frame).unwrap_err();
    // Another number of maps is another text.
    let mut other = frame.clone();
    other.wgsl.maps = 3;
    assert!(matches!(refused(&other), GpuError::Key { .. }));
    // A layer too far, and a view too many.
    let mut beyond = frame.clone();
    beyond.views[1].layer = 2;
    let error = refused(&beyond);
    assert!(matches!(error, GpuError::Viewport { view: 1, layer: 2, layers: 2, .. }), "{error:?}");
    assert!(error.to_string().ends_with("of layer 2; legal: inside layers 0 to 1 of 512x512 texels"), "{error}");
    let mut third = frame.clone();
    third.views.push(frame.views[0].clone());
    assert_eq!(refused(&third), GpuError::Views { views: 3, most: 2 });
    // Every view's matrix has a place of its own, where the device can bind it.
    let alignment = stage.gpu.device().limits().min_uniform_buffer_offset_alignment;
    assert!(maps.caster_offset(1) > 0 && maps.caster_offset(1).is_multiple_of(alignment));
    let renderer = Renderer::new(&stage.gpu, frame.wgsl);
    let race = renderer.race(&stage.gpu, &stage.scene, &camera, &frame, &maps, 3).unwrap();
    assert!(race.casters_ratio > 0.1 && race.receivers_ratio > 0.1, "{race:?}");
}
