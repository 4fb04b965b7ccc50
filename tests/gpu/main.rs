//! The library's shaders through the library's wgpu layer, against rays.

mod many;
mod probe;
#[path = "../support/mod.rs"]
mod support;
mod tiles;

use antumbra::gpu::{GpuError, ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::gpu::{Clock, Gpu, GpuFailure, GpuScene, RenderOptions, Renderer, read_depth};
use antumbra::lab::scene::SceneModel;
use antumbra::warp::Warp;
use antumbra::{
    Camera, Encoding, FitInput, Light, MapBudget, Pcf, Projection, Remix, Scene, ShadowFrame, ShadowTechnique,
    techniques,
};
use glam::{DVec2, DVec3, UVec2};

const SIZE: UVec2 = UVec2::new(320, 240);

/// Everything that one picture needs.
struct Stage {
    gpu: Gpu,
    model: SceneModel,
    scene: GpuScene,
    origin: DVec3,
}

impl Stage {
    fn new(origin: DVec3) -> Option<Self> {
        let gpu = support::gpu()?;
        let model = support::boxes();
        let scene = GpuScene::upload(&gpu, &model, origin).unwrap();
        Some(Self { gpu, model, scene, origin })
    }

    fn fit(&self, technique: &Remix, camera: Camera, side: u32) -> ShadowFrame {
        technique
            .fit(&FitInput {
                camera,
                light: Light::Directional { travel: support::travel() },
                scene: Scene::within(support::bounds(&self.model)),
                map: MapBudget::one(side),
                origin: self.origin,
                previous: None,
            })
            .unwrap()
    }

    fn maps(&self, frame: &ShadowFrame, side: u32) -> ShadowMaps {
        let descriptor = ShadowMapsDescriptor { label: Some("test"), key: frame.wgsl, map: MapBudget::one(side) };
        ShadowMaps::new(self.gpu.device(), &descriptor).unwrap()
    }

    /// A frame, its maps, and what draws it.
    fn ready(&self, technique: &Remix, camera: Camera, side: u32) -> (ShadowFrame, ShadowMaps, Renderer) {
        let frame = self.fit(technique, camera, side);
        let maps = self.maps(&frame, side);
        let renderer = Renderer::new(&self.gpu, frame.wgsl);
        (frame, maps, renderer)
    }

    fn picture(&self, technique: &Remix, camera: Camera, side: u32) -> Vec<u8> {
        let (frame, maps, renderer) = self.ready(technique, camera, side);
        let options = RenderOptions::default();
        renderer.render(&self.gpu, &self.scene, &camera, &frame, &maps, &options).unwrap().mask
    }
}

/// What a ray through the middle of a pixel says.
#[derive(Clone, Copy, PartialEq)]
enum Truth {
    /// Sky, or a surface that light reaches.
    Lit,
    /// A surface that faces the light, and something between them.
    Shadowed,
    /// A surface that faces away: lighting is zero there, and a filter's fringe cannot be seen.
    Away,
}

fn truth(model: &SceneModel, camera: &Camera, pixel: DVec2) -> Truth {
    let ndc = pixel / camera.viewport.as_dvec2() * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
    let (from, along) = match camera.projection {
        Projection::Perspective { left, right, down, up, .. } => {
            let at = DVec2::new(left, down) + (ndc + 1.0) * 0.5 * DVec2::new(right - left, up - down);
            (DVec3::ZERO, at.extend(-1.0))
        }
        Projection::Orthographic { left, right, down, up, .. } => {
            let at = DVec2::new(left, down) + (ndc + 1.0) * 0.5 * DVec2::new(right - left, up - down);
            (at.extend(0.0), DVec3::NEG_Z)
        }
    };
    let from = camera.world_from_view.transform_point3(from);
    let along = camera.world_from_view.transform_vector3(along);
    let Some((distance, triangle)) = support::trace(model, from, along, 1e-9) else { return Truth::Lit };
    let at = from + along * distance;
    let [a, b, c] = model.triangles[triangle].map(|vertex| model.positions[vertex as usize]);
    let normal = (b - a).cross(c - a);
    // Seen from one side and lit from the other.
    if normal.dot(along) * normal.dot(support::travel()) <= 0.0 {
        return Truth::Away;
    }
    let lit = support::trace(model, at, -support::travel(), 1e-6).is_none();
    if lit { Truth::Lit } else { Truth::Shadowed }
}

/// Share of wrong pixels among those whose neighbourhood (two pixels) agrees: no edge of light or of the scene is near.
fn wrong_in_the_interior(model: &SceneModel, camera: &Camera, mask: &[u8]) -> (usize, usize) {
    let UVec2 { x: width, y: height } = camera.viewport;
    let row = |y: u32| (0..width).map(move |x| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
    let lit: Vec<Truth> = (0..height).flat_map(row).map(|pixel| truth(model, camera, pixel)).collect();
    let (width, height) = (width as usize, height as usize);
    let (mut wrong, mut counted) = (0, 0);
    for y in 2..height - 2 {
        for x in 2..width - 2 {
            let expected = lit[y * width + x];
            let agree =
                (y - 2..=y + 2).all(|y| lit[y * width + x - 2..=y * width + x + 2].iter().all(|l| *l == expected));
            if agree && expected != Truth::Away {
                counted += 1;
                wrong += usize::from((mask[y * width + x] >= 128) != (expected == Truth::Lit));
            }
        }
    }
    (wrong, counted)
}

/// Every filter, warped maps and uniform ones: away from edges the picture is the rays' picture.
#[test]
fn shadows_are_where_rays_say() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(SIZE);
    for filter in Pcf::ALL {
        let technique = Remix { encoding: Encoding::Depth(filter), ..Remix::default() };
        let mask = stage.picture(&technique, camera, 1024);
        if let Some(folder) = std::env::var_os("ANTUMBRA_PICTURES") {
            let path = std::path::Path::new(&folder).join(format!("gpu_{}.png", filter.name()));
            image::save_buffer(path, &mask, SIZE.x, SIZE.y, image::ColorType::L8).unwrap();
        }
        let (wrong, counted) = wrong_in_the_interior(&stage.model, &camera, &mask);
        assert!(counted > 55_000, "{counted}");
        eprintln!("{filter:?}: {wrong} of {counted}");
        assert!(wrong * 2_000 < counted, "{filter:?}: {wrong} of {counted}");
    }
    for technique in warped() {
        for filter in [Pcf::Hardware2x2, Pcf::Box5x5] {
            let technique = Remix { encoding: Encoding::Depth(filter), ..technique };
            let mask = stage.picture(&technique, camera, 1024);
            let (wrong, counted) = wrong_in_the_interior(&stage.model, &camera, &mask);
            eprintln!("{:?} {filter:?}: {wrong} of {counted}", technique.warp);
            assert!(wrong * 2_000 < counted, "{technique:?}: {wrong} of {counted}");
        }
    }
}

/// The same picture from every projection that the library knows, and far from the world's origin.
#[test]
fn every_projection_and_origin() {
    let Some(stage) = Stage::new(DVec3::new(3.0, -2.0, 5.0)) else { return };
    let base = support::camera(SIZE);
    let Projection::Perspective { left, right, down, up, near, .. } = base.projection else { unreachable!() };
    let infinite = Projection::Perspective { left, right, down, up, near, far: f64::INFINITY };
    let off_centre = Projection::Perspective { left: 0.3 * left, right, down, up: 0.5 * up, near, far: 60.0 };
    let box_ = Projection::Orthographic { left: -6.0, right: 8.0, down: -5.0, up: 5.5, near: 0.5, far: 40.0 };
    for projection in [infinite, off_centre, box_] {
        let camera = Camera { projection, ..base };
        let mask = stage.picture(&Remix::default(), camera, 1024);
        let (wrong, counted) = wrong_in_the_interior(&stage.model, &camera, &mask);
        assert!(counted > 50_000, "{counted}");
        assert!(wrong * 2_000 < counted, "{projection:?}: {wrong} of {counted}");
    }
}

/// Techniques whose maps are warped here, each by another strength.
fn warped() -> [Remix; 5] {
    let fixed = |strength| Remix { warp: Warp::Fixed { strength }, ..Remix::default() };
    [fixed(0.4), fixed(20.0), techniques::tsm(), techniques::lispsm(), Remix { guard: false, ..techniques::psm() }]
}

/// A map holds the linear depth of the first surface along the light, and 1 where there is none,
/// whatever it is warped by.
#[test]
fn the_map_holds_analytic_depth() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    holds_analytic_depth(&stage, &Remix::default());
    let strengths = warped().map(|technique| holds_analytic_depth(&stage, &technique));
    assert!(strengths.iter().all(|strength| *strength > 0.3), "{strengths:?}");
    assert!(strengths.iter().any(|strength| *strength > 4.0), "{strengths:?}");
}

/// Checks one map texel by texel; gives back the strength of its warp.
fn holds_analytic_depth(stage: &Stage, technique: &Remix) -> f32 {
    let (camera, side) = (support::camera(SIZE), 128_u32);
    let (frame, maps, renderer) = stage.ready(technique, camera, side);
    renderer.render(&stage.gpu, &stage.scene, &camera, &frame, &maps, &RenderOptions::default()).unwrap();
    let map = read_depth(&stage.gpu, &maps, 0).unwrap();
    let clip_from_render = frame.views[0].clip_from_render.as_dmat4();
    let render_from_clip = clip_from_render.inverse();
    let travel = support::travel();
    let viewport = frame.views[0].viewport;
    let (low, extent) = (UVec2::new(viewport.x, viewport.y), UVec2::new(viewport.z, viewport.w));
    let (mut hits, mut misses, mut strays) = (0, 0, 0);
    for y in 0..side {
        for x in 0..side {
            let stored = map[(y * side + x) as usize];
            // The rim outside the viewport stays clear.
            let at = UVec2::new(x, y);
            if at.cmplt(low).any() || at.cmpge(low + extent).any() {
                assert_eq!(stored.to_bits(), 1.0_f32.to_bits(), "{at}");
                continue;
            }
            let centre = ((at - low).as_dvec2() + 0.5) / extent.as_dvec2();
            let ndc = centre * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
            let start = render_from_clip.project_point3(ndc.extend(0.0));
            let Some((distance, _)) = support::trace(&stage.model, start, travel, 0.0) else {
                misses += 1;
                strays += usize::from(stored < 1.0);
                continue;
            };
            let at = (start + travel * distance).as_vec3();
            let expected = frame.views[0].depth_from_render.dot(at.extend(1.0));
            hits += 1;
            // The rasteriser snaps vertices to 1/256 texel; a plane's depth moves by that share of its slope, which
            // grows with the size of texels.
            let w = clip_from_render.row(3).dot(at.as_dvec3().extend(1.0)) as f32;
            strays += usize::from((stored - expected.min(1.0)).abs() > 1e-4 * w.max(1.0));
        }
    }
    // Texels whose centre is within a 256th of an edge may fall to either side.
    eprintln!("strength {}: {strays} strays of {hits} hits, {misses} misses", frame.views[0].warp_strength);
    assert!(hits > 5_000 && misses > 100, "{technique:?}: {hits} {misses}");
    assert!(strays * 200 < hits, "{technique:?}: {strays} of {hits}");
    frame.views[0].warp_strength
}

/// What does not fit together is refused, with both sides named.
#[test]
fn misfits_are_errors() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(SIZE);
    let frame = stage.fit(&Remix::default(), camera, 256);
    let other = Remix { encoding: Encoding::Depth(Pcf::Box3x3), ..Remix::default() };
    let other = stage.fit(&other, camera, 256);
    // Key.
    let maps = stage.maps(&frame, 256);
    let error = maps.prepare(stage.gpu.queue(), &other).unwrap_err();
    assert_eq!(error, GpuError::Key { expected: frame.wgsl, actual: other.wgsl });
    assert!(error.to_string().contains("Box3x3") && error.to_string().contains("Hardware2x2"), "{error}");
    // Size: texture coordinates of the frame would count other texels, in larger maps as well.
    for side in [128, 512] {
        let error = stage.maps(&frame, side).prepare(stage.gpu.queue(), &frame).unwrap_err();
        assert_eq!(error, GpuError::FrameSide { side: 256, expected: side });
        assert!(error.to_string().contains("256; legal: the side of these maps"), "{error}");
    }
    let mut outside = frame.clone();
    outside.views[0].viewport.x = 100;
    let error = maps.prepare(stage.gpu.queue(), &outside).unwrap_err();
    assert!(matches!(error, GpuError::Viewport { side: 256, .. }), "{error}");
    let none = ShadowMapsDescriptor { label: None, key: frame.wgsl, map: MapBudget::one(0) };
    let error = ShadowMaps::new(stage.gpu.device(), &none).unwrap_err();
    assert!(error.to_string().starts_with("map.side is 0; legal: 1 to "), "{error}");
    // Views.
    let mut doubled = frame.clone();
    doubled.views.push(frame.views[0].clone());
    let error = maps.prepare(stage.gpu.queue(), &doubled).unwrap_err();
    assert_eq!(error, GpuError::Views { views: 2, most: 1 });
    // Origin.
    let elsewhere = GpuScene::upload(&stage.gpu, &stage.model, DVec3::X).unwrap();
    let renderer = Renderer::new(&stage.gpu, frame.wgsl);
    let options = RenderOptions::default();
    let error = renderer.render(&stage.gpu, &elsewhere, &camera, &frame, &maps, &options).unwrap_err();
    assert_eq!(error, GpuFailure::Origin { scene: DVec3::X, frame: DVec3::ZERO });
    // A broken model.
    let mut broken = stage.model.clone();
    broken.triangles[3][1] = 1_000_000;
    let error = GpuScene::upload(&stage.gpu, &broken, DVec3::ZERO).unwrap_err();
    assert!(error.to_string().starts_with("scene.triangles is 1000000"), "{error}");
}

/// An empty scene is a sky; a frame without views is lit.
#[test]
fn nothing_is_lit() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(SIZE);
    let (mut frame, maps, renderer) = stage.ready(&Remix::default(), camera, 64);
    let options = RenderOptions::default();
    let empty = GpuScene::upload(&stage.gpu, &SceneModel::default(), DVec3::ZERO).unwrap();
    let image = renderer.render(&stage.gpu, &empty, &camera, &frame, &maps, &options).unwrap();
    assert!(image.mask.iter().all(|value| *value == 255));
    // The shadowed picture, then the same maps after a frame without views.
    let image = renderer.render(&stage.gpu, &stage.scene, &camera, &frame, &maps, &options).unwrap();
    assert!(image.mask.contains(&0));
    let no_casters = Scene { casters: antumbra::Aabb::EMPTY, ..Scene::within(support::bounds(&stage.model)) };
    frame = Remix::default()
        .fit(&FitInput {
            camera,
            light: Light::Directional { travel: support::travel() },
            scene: no_casters,
            map: MapBudget::one(64),
            origin: DVec3::ZERO,
            previous: None,
        })
        .unwrap();
    assert!(frame.views.is_empty() && !frame.left_out.is_empty());
    let image = renderer.render(&stage.gpu, &stage.scene, &camera, &frame, &maps, &options).unwrap();
    assert!(image.mask.iter().all(|value| *value == 255));
}

/// Times are positive, and no longer than the whole call.
#[test]
fn times_are_sane() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(UVec2::new(640, 480));
    let (frame, maps, renderer) = stage.ready(&Remix::default(), camera, 1024);
    let start = std::time::Instant::now();
    let options = RenderOptions { repetitions: 5 };
    let image = renderer.render(&stage.gpu, &stage.scene, &camera, &frame, &maps, &options).unwrap();
    let wall = start.elapsed().as_secs_f64() * 1e3;
    let times = image.timings;
    eprintln!("{} ({}): {times:?}, whole call {wall:.1} ms", stage.gpu.adapter(), stage.gpu.backend());
    assert_eq!(times.clock == Clock::Timestamps, stage.gpu.has_timestamps());
    assert!(times.casters_ms > 0.0 && times.receivers_ms > 0.0, "{times:?}");
    assert!(5.0 * 0.5 * (times.casters_ms + times.receivers_ms) < wall, "{times:?} {wall}");
}

/// The race against passes written by hand runs; its figures are the benchmark's business.
#[test]
fn races_are_run() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(UVec2::new(640, 480));
    let (frame, maps, renderer) = stage.ready(&Remix::default(), camera, 1024);
    let race = renderer.race(&stage.gpu, &stage.scene, &camera, &frame, &maps, 11).unwrap();
    eprintln!("{} ({}): {race:?}", stage.gpu.adapter(), stage.gpu.backend());
    let receivers = [race.receivers_ratio, race.receivers_bare_ratio, race.receivers_vertex_ratio];
    for ratio in [race.casters_ratio, race.whole_ratio, race.whole_bare_ratio].into_iter().chain(receivers) {
        assert!(ratio > 0.2 && ratio < 5.0, "{race:?}");
    }
}
