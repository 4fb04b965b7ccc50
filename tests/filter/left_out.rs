//! What is not asked for is not done: passes, levels, and anything at all for maps of depths.

use antumbra::gpu::{ShadowMaps, wgpu};
use antumbra::lab::gpu::Renderer;
use antumbra::{
    Aabb, FitInput, Light, MapBudget, Part, Radius, Remix, Scene, ShadowFrame, ShadowTechnique, techniques,
};
use glam::DVec3;

use crate::stage::{SIZE, Stage, encoding, fit, tiled};
use crate::support;

/// Number of passes that filtering a frame records, each announced with its number and their count.
fn passes(stage: &Stage, maps: &ShadowMaps, frame: &ShadowFrame) -> usize {
    let mut encoder = stage.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut announced = Vec::new();
    maps.filter(&mut encoder, frame, &mut |number, count| {
        announced.push((number, count));
        None
    });
    stage.gpu.queue().submit([encoder.finish()]);
    let count = announced.len();
    assert!(announced.iter().copied().eq((0..count).map(|number| (number, count))), "{announced:?}");
    count
}

/// A frame in which nothing casts.
fn without_views(remix: &Remix, map: MapBudget) -> ShadowFrame {
    let scene = Scene { casters: Aabb::EMPTY, ..Scene::within(support::bounds(&support::boxes())) };
    let light = Light::Directional { travel: support::travel() };
    let camera = support::camera(SIZE);
    let frame = remix.fit(&FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None }).unwrap();
    assert!(frame.views.is_empty() && !frame.left_out.is_empty());
    frame
}

/// Two passes a view, one a level of each layer in use; none without views, and everything is lit then, whether maps
/// were drawn before or not.
#[test]
fn frames_without_views_are_not_filtered() {
    let Some(stage) = Stage::new() else { return };
    for moments in stage.supported() {
        let remix = Remix { encoding: encoding(moments, Radius::Texels(1.5), false), ..techniques::fsm() };
        let map = MapBudget::one(128);
        let (empty, frame) = (without_views(&remix, map), fit(&remix, map));
        let (maps, renderer) = (stage.maps(&frame), Renderer::new(&stage.gpu, frame.wgsl));
        assert_eq!(passes(&stage, &maps, &empty), 0);
        let levels = frame.uniforms.views[0].moments[1] as usize;
        // Eight sums make one: 128 texels take three passes along each axis.
        let of_view = if moments.is_summed() { 2 * 3 } else { 2 + levels };
        assert_eq!(passes(&stage, &maps, &frame), moments.layers() as usize * of_view);
        // Never drawn; drawn; drawn before.
        let fresh = stage.maps(&frame);
        let dark = |mask: &[u8]| mask.iter().filter(|lit| **lit < 255).count();
        assert_eq!(dark(&stage.draw(&renderer, &empty, &fresh)), 0, "{moments:?}: maps that were never drawn");
        assert!(dark(&stage.draw(&renderer, &frame, &maps)) > 500, "{moments:?}");
        assert_eq!(dark(&stage.draw(&renderer, &empty, &maps)), 0, "{moments:?}: maps that were drawn before");
    }
}

/// Layers without a view of this frame get no mips; the passes of six maps are those of six maps.
#[test]
fn passes_are_those_of_the_views() {
    let Some(stage) = Stage::new() else { return };
    for moments in stage.supported().filter(|moments| moments.linear) {
        let (remix, map) = tiled(encoding(moments, Radius::Texels(1.5), false), 256);
        let mut frame = fit(&remix, map);
        // Pixels here see few texels: all levels are read, as far away.
        let (pairs, levels) = (moments.layers() as usize, moments.last_level(256) as usize);
        frame.uniforms.views.iter_mut().for_each(|view| view.moments[1] = levels as f32);
        let maps = stage.maps(&frame);
        let views = frame.views.len();
        assert_eq!(passes(&stage, &maps, &frame), pairs * (2 * views + 2 * levels));
        frame.views.retain(|view| view.layer == 0);
        assert!((1..views).contains(&frame.views.len()));
        assert_eq!(passes(&stage, &maps, &frame), pairs * (2 * frame.views.len() + levels));
    }
}

/// No more levels are made than pixels see texels: none for a coarse map, and that is said; more, the finer the map is.
#[test]
fn levels_follow_the_picture() {
    let Some(stage) = Stage::new() else { return };
    let moments = stage.supported().find(|moments| moments.mips).expect("some have mips");
    let remix = Remix { encoding: encoding(moments, Radius::Texels(1.5), false), ..techniques::fsm() };
    let levels = [32, 512, 8192].map(|side| {
        let frame = fit(&remix, MapBudget::one(side));
        let said = frame.left_out.iter().any(|cut| cut.part == Part::Levels(0));
        let levels = frame.uniforms.views[0].moments[1];
        assert_eq!(said, levels == 0.0, "{side}: {:?}", frame.left_out);
        levels
    });
    println!("levels of maps of 32, 512 and 8192 texels: {levels:?}");
    assert!(levels[0] == 0.0 && levels[0] < levels[2] && levels[1] <= levels[2], "{levels:?}");
}

/// One level without mips; with them as many as there are.
#[test]
fn levels_are_those_that_are_read() {
    let Some(stage) = Stage::new() else { return };
    for moments in stage.supported() {
        for side in [1, 2, 100, 128] {
            let remix = Remix { encoding: encoding(moments, Radius::Texels(1.5), false), ..techniques::fsm() };
            let frame = fit(&remix, MapBudget::one(side));
            let maps = stage.maps(&frame);
            let levels = maps.moments_texture().unwrap().mip_level_count();
            let expected = if moments.mips { side.ilog2().min(6) + 1 } else { 1 };
            assert_eq!(levels, expected, "{moments:?}, side {side}");
            assert!(frame.uniforms.views[0].moments[1] < levels as f32);
        }
    }
}

/// Maps of depths: no texture, no pass, no feature.
#[test]
fn depths_are_not_filtered() {
    let Some(stage) = Stage::new() else { return };
    for remix in [techniques::fsm(), techniques::tsm(), techniques::cascades()] {
        let map = MapBudget { side: 128, layers: 4, views: 8 };
        let frame = fit(&remix, map);
        let maps = stage.maps(&frame);
        assert!(maps.moments_texture().is_none() && !frame.views.is_empty());
        assert_eq!(passes(&stage, &maps, &frame), 0);
        assert_eq!(antumbra::gpu::required_features(frame.wgsl), wgpu::Features::empty());
        assert_eq!(maps.bytes(), u64::from(maps.layers()) * 128 * 128 * 4);
    }
}
