//! Footprints: the Jacobian against rays through neighbouring pixels, the textbook's values, what a fit predicts of them,
//! and the debug view for shaders against its twin and the exact function.

mod common;
mod support;

use std::sync::atomic::{AtomicU32, Ordering};

use antumbra::aliasing::{PointFootprint, Spread, footprint_at, perspective_at, perspective_spread};
use antumbra::encoding::footprint::{antumbra_footprint, antumbra_footprint_colour};
use antumbra::gpu::wgpu;
use antumbra::lab::gpu::Gpu;
use antumbra::transpile::Shader;
use antumbra::warp::Warp;
use antumbra::{
    Aabb, Camera, FitInput, Light, MapBudget, Projection, Remix, Scene, ShadowFrame, ShadowTechnique, ViewUniforms,
    WgslKey, techniques, wgsl,
};
use bytemuck::{Pod, Zeroable};
use common::{Inputs, direction, in_view, inputs, view_point};
use glam::{DVec2, DVec3, DVec4, UVec2, Vec3, Vec4};
use proptest::prelude::*;

/// The named techniques as they come, as published, and warps of every strength.
fn remixes() -> impl Strategy<Value = Remix> {
    let named = (prop::sample::select(techniques::NAMED), any::<bool>());
    prop_oneof![
        3 => named.prop_map(|((_, technique), guard)| Remix { guard, ..technique() }),
        1 => (-2.0..3.0_f32).prop_map(|log| Remix { warp: Warp::Fixed { strength: 10.0_f32.powf(log) }, ..Remix::default() }),
    ]
}

fn shares() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.0..=1.0_f64)
}

/// Where a ray through the picture meets the plane of a receiver, relative to the point that is looked at.
struct Sight {
    from_eye: DVec3,
    normal: DVec3,
    axes: [DVec3; 3],
    spreads: bool,
}

impl Sight {
    fn new(camera: &Camera, origin: DVec3, position: DVec3, normal: DVec3) -> Self {
        let axes = [camera.world_from_view.x_axis, camera.world_from_view.y_axis, -camera.world_from_view.z_axis];
        let spreads = matches!(camera.projection, Projection::Perspective { .. });
        Self { from_eye: position - (camera.eye() - origin), normal, axes: axes.map(DVec4::truncate), spreads }
    }

    /// The ray that is `off` the one through the point: tangents, or world units of an orthographic camera.
    fn meet(&self, off: DVec2) -> DVec3 {
        let [right, up, forward] = self.axes;
        let depth = self.from_eye.dot(forward);
        let aside = right * off.x + up * off.y;
        if self.spreads {
            // The point is at depth times its own ray.
            let ray = self.from_eye / depth + aside;
            let farther = -depth * self.normal.dot(aside) / self.normal.dot(ray);
            (self.from_eye / depth) * farther + aside * (depth + farther)
        } else {
            aside - forward * (self.normal.dot(aside) / self.normal.dot(forward))
        }
    }
}

/// Texels between the places in the map of a point and of one `step` away: no difference of large numbers.
fn texels(view: &ViewUniforms, side: u32, position: DVec3, step: DVec3) -> DVec2 {
    let [u, v, w] = [view.u_from_render, view.v_from_render, view.w_from_render].map(|row| Vec4::from(row).as_dvec4());
    let (at, before) = (position.extend(1.0), w.dot(position.extend(1.0)));
    let after = before + w.truncate().dot(step);
    let moved = |row: DVec4| (row - w * (row.dot(at) / before)).truncate().dot(step) / after;
    DVec2::new(moved(u), moved(v)) * f64::from(side)
}

/// Share of itself by which anything may change over a step of the stencil: its fourth power is the error, 1e-16 over it
/// the rounding.
const STEP: f64 = 2e-4;

/// J by the five-point stencil along both axes of the picture; `None` where the surface is all but seen from its edge.
fn differences(view: &ViewUniforms, side: u32, camera: &Camera, position: DVec3, sight: &Sight) -> Option<[DVec2; 2]> {
    let [_, _, forward] = sight.axes;
    let ray = if sight.spreads { sight.from_eye / sight.from_eye.dot(forward) } else { forward };
    let facing = sight.normal.dot(ray).abs();
    let (pixel, depth) = (pixel_size(camera), if sight.spreads { sight.from_eye.dot(forward) } else { 1.0 });
    let w = Vec4::from(view.w_from_render).as_dvec4();
    // Neither the cosine nor w may change by more than the share.
    let reach = depth * (1.0 + ray.length() / facing);
    let by_w = w.dot(position.extend(1.0)) / (w.truncate().length() * reach).max(1e-300);
    let step = STEP * facing.min(by_w).min((pixel * camera.viewport.as_dvec2()).max_element());
    (facing > 1e-6).then(|| {
        [DVec2::X, DVec2::Y].map(|axis| {
            let at = |times: f64| texels(view, side, position, sight.meet(axis * (step * times)));
            let slope = ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * step);
            slope * axis.dot(pixel)
        })
    })
}

/// What rounding in f64 does to the gradients of a map, texels per world unit: places in it are differences of numbers that grow with the
/// distance from the origin.
fn doubt(view: &ViewUniforms, side: u32, position: DVec3) -> f64 {
    let [u, v, w] = [view.u_from_render, view.v_from_render, view.w_from_render].map(|row| Vec4::from(row).as_dvec4());
    let (at, size) = (w.dot(position.extend(1.0)), position.extend(1.0).abs());
    let of =
        |row: DVec4| row.truncate().length() + w.truncate().length() * (row.abs().dot(size) + w.abs().dot(size)) / at;
    8.0 * f64::EPSILON * of(u).max(of(v)) * f64::from(side) / at
}

/// Size of a pixel: tangents, or world units of an orthographic camera.
fn pixel_size(camera: &Camera) -> DVec2 {
    let size = match camera.projection {
        Projection::Perspective { left, right, down, up, .. }
        | Projection::Orthographic { left, right, down, up, .. } => DVec2::new(right - left, up - down),
    };
    size / camera.viewport.as_dvec2()
}

/// Least and largest singular value, and the determinant.
fn singular([x, y]: [DVec2; 2]) -> (f64, f64, f64) {
    let (sum, difference) = ((x - y.perp()).length(), (x + y.perp()).length());
    (0.5 * (sum - difference).abs(), 0.5 * (sum + difference), x.perp_dot(y).abs())
}

fn fit(inputs: &Inputs, remix: &Remix) -> Option<ShadowFrame> {
    remix.fit(&inputs.fit_input()).ok().filter(|frame| !frame.views.is_empty())
}

fn at(frame: &ShadowFrame, inputs: &Inputs, position: DVec3, normal: DVec3) -> Option<PointFootprint> {
    footprint_at(&frame.uniforms.views[0], inputs.side, &inputs.camera, inputs.origin, position, normal)
}

/// Cases, those with a footprint, those of a warped map, and those in which J is known to the last of the digits asked for.
static REACHED: [AtomicU32; 4] = [const { AtomicU32::new(0) }; 4];

fn count(which: usize) {
    REACHED[which].fetch_add(1, Ordering::Relaxed);
}

#[test]
fn footprints_are_what_neighbouring_rays_see() {
    over_hostile_frames();
    let [cases, found, warped, sharp] = REACHED.each_ref().map(|count| count.load(Ordering::Relaxed));
    println!("{cases} cases, {found} with a footprint, {warped} of them warped, {sharp} compared to 1e-6");
    assert!(found * 5 > cases && warped * 10 > found && sharp * 3 > found, "{cases} {found} {warped} {sharp}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40_000, max_shrink_iters: 500, ..ProptestConfig::default() })]

    fn over_hostile_frames(inputs in inputs(), remix in remixes(), shares in shares(), free in direction(), on_axis in any::<bool>()) {
        count(0);
        let inputs = Inputs { casters: inputs.receivers, ..inputs };
        let Some(frame) = fit(&inputs, &remix) else { return Ok(()) };
        let seen = view_point(&inputs.camera, shares).clamp(inputs.receivers.min, inputs.receivers.max);
        let position = seen - inputs.origin;
        // Often a floor or a wall, else anything.
        let normal = if on_axis { DVec3::Y } else { free };
        let Some(found) = at(&frame, &inputs, position, normal) else { return Ok(()) };
        count(1);
        let view = &frame.uniforms.views[0];
        let sight = Sight::new(&inputs.camera, inputs.origin, position, normal);
        let Some(columns) = differences(view, inputs.side, &inputs.camera, position, &sight) else { return Ok(()) };
        let (least, most, determinant) = singular(columns);
        if view.w_from_render[..3] != [0.0; 3] {
            count(2);
        }
        // Differences know J to nine digits of its largest entry; far from the origin, both know the map less well.
        let pixel = [DVec2::X, DVec2::Y].map(|axis| sight.meet(axis * 1e-6).length() * 1e6).into_iter().fold(0.0, f64::max);
        let noise = 1e-9 * most + doubt(view, inputs.side, position) * pixel * pixel_size(&inputs.camera).max_element();
        if noise < 1e-6 * least {
            count(3);
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b;
            prop_assert!(close(found.texels_per_pixel, least), "{} is {}", found.texels_per_pixel, least);
            prop_assert!(close(found.pixels_per_texel, 1.0 / least), "{} is {}", found.pixels_per_texel, 1.0 / least);
            prop_assert!(close(found.perspective * found.projection, found.pixels_per_texel));
            prop_assert!(close(found.area, 1.0 / determinant), "{} is {}", found.area, 1.0 / determinant);
        }
        prop_assert!((found.texels_per_pixel - least).abs() <= 1e-6 * least + noise, "{} is {} of {}", found.texels_per_pixel, least, most);
    }
}

/// Points in view; by how many millionths the perspective part lies above the predicted range in warped maps, and by what
/// per cent of it below.
static PREDICTED: [AtomicU32; 3] = [const { AtomicU32::new(0) }; 3];

/// A texel's side is predicted at the corners of what is in view, its longest extent measured anywhere: a parallelogram's is at most
/// √2 of its longest side, and the error W²/ζ of a warped map is least somewhere in between.
#[test]
fn predicted_extremes_hold() {
    predicted_extremes_hold_over_hostile_frames();
    let [points, above, below] = PREDICTED.each_ref().map(|count| count.load(Ordering::Relaxed));
    println!("{points} points; warped maps: at most {above} millionths above the prediction, {below} % below it");
    assert!(points > 10_000);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40_000, max_shrink_iters: 500, ..ProptestConfig::default() })]

    fn predicted_extremes_hold_over_hostile_frames(inputs in inputs(), remix in remixes(), shares in shares()) {
        // What nothing can shadow is not in the body: here everything casts.
        let inputs = Inputs { casters: inputs.receivers, ..inputs };
        let Some(frame) = fit(&inputs, &remix) else { return Ok(()) };
        let point = view_point(&inputs.camera, shares).clamp(inputs.receivers.min, inputs.receivers.max);
        if !in_view(&inputs, point) {
            return Ok(());
        }
        let view = &frame.uniforms.views[0];
        let Some(found) = perspective_at(view, inputs.side, &inputs.camera, inputs.origin, point - inputs.origin) else { return Ok(()) };
        // Where a body is a speck far from the origin, w is as good as positions in f32, and not as predicted.
        let (w, at) = (Vec4::from(view.w_from_render).as_dvec4(), point - inputs.origin);
        if w.truncate().length() * at.length() * f64::from(f32::EPSILON) > 1e-3 * w.dot(at.extend(1.0)) {
            return Ok(());
        }
        let (least, most) = (f64::from(frame.predicted.min), f64::from(frame.predicted.max));
        PREDICTED[0].fetch_add(1, Ordering::Relaxed);
        let warped = view.w_from_render[..3] != [0.0; 3];
        // Rows are rounded to f32.
        let (below, above) = if warped { (0.0, std::f64::consts::SQRT_2 * 1.05) } else { (0.9999, 1.0001) };
        if warped && most > 0.0 {
            PREDICTED[1].fetch_max(((found / most - 1.0).max(0.0) * 1e6) as u32, Ordering::Relaxed);
            PREDICTED[2].fetch_max(((1.0 - found / least).max(0.0) * 1e2) as u32, Ordering::Relaxed);
        }
        prop_assert!(found >= least * below && found <= most * above, "{} is outside {} to {}", found, least, most);
    }
}

/// Half the picture's height at distance 1 in the tests below: narrow, so that texels are longest along the view.
const TANGENT: f64 = 0.1;

/// A level camera over a plain, from 1 to 100, and light from above.
fn overhead(strength: f32) -> (ShadowFrame, Camera) {
    let eye = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y);
    let camera =
        Camera { viewport: UVec2::splat(1000), ..Camera::perspective(eye, 2.0 * TANGENT.atan(), 1.0, 1.0, 100.0) };
    let world = Aabb::new(DVec3::splat(-1000.0), DVec3::splat(1000.0));
    let remix = Remix { warp: Warp::Fixed { strength }, ..Remix::default() };
    let input = FitInput {
        camera,
        light: Light::Directional { travel: DVec3::NEG_Y },
        scene: Scene::within(world),
        map: MapBudget::one(SIDE),
        origin: DVec3::ZERO,
        previous: None,
    };
    (remix.fit(&input).expect("a legal view"), camera)
}

/// Texels of those maps: a border of a few must not show.
const SIDE: u32 = 8192;

/// The table of E(z), the error along the view of a map seen level under light from above, and the storage S = `M_s` `M_t`
/// of uniform (9900) and perspective (99) warps at a ratio of depths of 100: MATH.md section 8.
#[test]
fn overhead_light_golden_values() {
    let depths = [1.0, 2.0, 5.0, 10.0, 24.785_05, 50.0, 100.0_f64];
    for (strength, errors, storage) in [
        (0.0, [99.0, 49.5, 19.8, 9.9, 3.99434, 1.98, 0.99], 9900.0),
        (99.0, [0.99, 1.98, 4.95, 9.9, 24.5372, 49.5, 99.0], 99.0),
        (9.0, [9.9, 5.89091, 3.68182, 3.27273, 3.99434, 5.89091, 9.9], 99.0),
    ] {
        let (frame, camera) = overhead(strength);
        // The error of one texel over the window, in pictures whose half height at distance 1 is one pixel.
        let unit = 0.5 * f64::from(SIDE) * 2.0 * TANGENT / 1000.0 * 2.0;
        let (mut most_along, mut most_across) = (0.0_f64, 0.0_f64);
        for (depth, expected) in depths.into_iter().zip(errors) {
            let inside = depth.clamp(1.0, 99.99);
            // Half-way between light and camera, so that both see it at one slant.
            let found = footprint_at(
                &frame.uniforms.views[0],
                SIDE,
                &camera,
                DVec3::ZERO,
                DVec3::new(0.0, 0.0, -inside),
                DVec3::new(0.0, 3.0, 3.0),
            )
            .expect("in view");
            let along = found.perspective * unit;
            assert!((along / expected - 1.0).abs() < 5e-3, "κλ = {strength}, z = {depth}: {along} is {expected}");
            assert!((found.projection - 1.0).abs() < 2e-3, "{found:?}");
            // What is left of a texel's area is its extent across the view, in pictures of half width 1.
            let across = found.area * unit * unit / along / (2.0 * TANGENT);
            (most_along, most_across) = (most_along.max(along), most_across.max(across));
        }
        let found = most_along * most_across;
        assert!((found / storage - 1.0).abs() < 1e-2, "κλ = {strength}: storage {found} is {storage}");
    }
}

/// A floor that the light falls on at a slant: the projection part alone, and its limits.
#[test]
fn slants_are_projection() {
    let (frame, camera) = overhead(0.0);
    let view = &frame.uniforms.views[0];
    let at = |normal: DVec3| footprint_at(view, SIDE, &camera, DVec3::ZERO, DVec3::new(0.0, 0.0, -10.0), normal);
    let facing = perspective_at(view, SIDE, &camera, DVec3::ZERO, DVec3::new(0.0, 0.0, -10.0)).unwrap();
    for degrees in [5.0, 20.0, 45.0, 70.0, 85.0, 89.9_f64] {
        // Turned from the camera towards the light about the picture's horizontal: 1/tan times as long.
        let (sin, cos) = degrees.to_radians().sin_cos();
        let found = at(DVec3::new(0.0, sin, cos)).unwrap();
        assert_eq!(found.perspective, facing);
        // Texels are five times as long along the view as across it.
        let expected = (cos / sin).max(0.2);
        assert!((found.projection / expected - 1.0).abs() < 0.05, "{degrees}°: {} is {expected}", found.projection);
    }
    // Grazed by the light: endless. Seen from its edge: finite, and of no area.
    let grazed = at(DVec3::Z).unwrap();
    assert!(grazed.texels_per_pixel < 1e-5 && grazed.area > 1e3, "{grazed:?}");
    let edge = at(DVec3::Y).unwrap();
    assert!(edge.area == 0.0 && edge.texels_per_pixel > 0.0 && edge.texels_per_pixel.is_finite(), "{edge:?}");
}

/// No input gives NaN, and what has no footprint has none.
#[test]
fn total_on_anything() {
    let (frame, camera) = overhead(9.0);
    let view = &frame.uniforms.views[0];
    let mut wild =
        vec![DVec3::ZERO, DVec3::NEG_Z, DVec3::new(0.0, 0.0, -50.0), DVec3::Z, DVec3::X, DVec3::new(0.0, 1.0, 1.0)];
    for value in [1e-308, 1e-200, 1e-30, 1e30, 1e200, f64::MAX, f64::INFINITY, f64::NAN] {
        wild.extend([
            DVec3::new(value, 1.0, -2.0),
            DVec3::new(0.0, value, -3.0),
            DVec3::new(0.0, 0.0, -value),
            DVec3::splat(value),
        ]);
    }
    let mut found = 0;
    for lens in [
        camera,
        Camera {
            projection: Projection::Orthographic { left: -1.0, right: 1.0, down: -1.0, up: 1.0, near: 0.0, far: 9.0 },
            ..camera
        },
    ] {
        for (position, normal) in wild.iter().flat_map(|position| wild.iter().map(move |normal| (*position, *normal))) {
            for view in [view, &ViewUniforms::LIT] {
                let Some(point) = footprint_at(view, SIDE, &lens, DVec3::ZERO, position, normal) else { continue };
                found += 1;
                let values =
                    [point.texels_per_pixel, point.pixels_per_texel, point.perspective, point.projection, point.area];
                assert!(values.iter().all(|value| *value >= 0.0), "{position} {normal}: {point:?}");
                assert!(point.perspective > 0.0 && point.perspective.is_finite() && point.texels_per_pixel.is_finite());
            }
        }
    }
    assert!(found > 50, "{found}");
    let ahead = DVec3::new(0.0, 0.0, -10.0);
    let none = |view, position, normal| footprint_at(view, SIDE, &camera, DVec3::ZERO, position, normal).is_none();
    assert!(none(&ViewUniforms::LIT, ahead, DVec3::Y), "a view that reads lit has no texels");
    assert!(none(view, ahead, DVec3::ZERO) && none(view, DVec3::Z, DVec3::Y), "no direction; behind the eye");
    assert!(none(view, DVec3::new(500.0, 0.0, -10.0), DVec3::Y), "outside of the map");
}

#[test]
fn spreads_are_percentiles() {
    let mut values: Vec<f64> = (0..=100).rev().map(f64::from).collect();
    let expected = Spread { min: 0.0, low: 5.0, median: 50.0, high: 95.0, max: 100.0 };
    assert_eq!(Spread::of(&mut values), Some(expected));
    assert_eq!(Spread::of(&mut []), None);
    assert_eq!(Spread::of(&mut [f64::INFINITY, 2.0]).unwrap().min, 2.0);
    // Over the body: E(z) of a uniform map is 99/z, and half of log z lies beyond 10.
    let (frame, camera) = overhead(0.0);
    let spread = perspective_spread(&frame.views[0], &frame.uniforms.views[0], SIDE, &camera, DVec3::ZERO).unwrap();
    let (least, most) = (f64::from(frame.predicted.min), f64::from(frame.predicted.max));
    assert!(least < spread.min && spread.max < most, "{spread:?} is outside {least} to {most}");
    for (found, share) in [(spread.low, 0.95), (spread.median, 0.5), (spread.high, 0.05)] {
        let expected = most / 100.0_f64.powf(share);
        assert!((found / expected - 1.0).abs() < 0.12, "{found} is {expected}");
    }
}

/// The fragment keeps the contract of the library, behind every key.
#[test]
fn the_fragment_keeps_the_contract() {
    for word in
        ["#", "@", "override", "dpdx(", "dpdy(", "fwidth", "textureSample", "loop", "for ", "while", "ptr<", "__"]
    {
        assert!(!code_of(wgsl::FOOTPRINT).contains(word), "{word}");
    }
    for key in WgslKey::all() {
        let text = [wgsl::library(key).join("\n").as_str(), wgsl::FOOTPRINT].join("\n");
        let shader = Shader::parse(&text).unwrap_or_else(|error| panic!("{key:?}: {error}"));
        let names = |text: &Shader| -> Vec<String> {
            let functions = text.module.functions.iter().filter_map(|(_, function)| function.name.clone());
            functions.chain(text.module.constants.iter().filter_map(|(_, constant)| constant.name.clone())).collect()
        };
        for name in ["antumbra_footprint", "antumbra_footprint_colour"] {
            assert!(names(&shader).iter().any(|found| found == name), "{key:?}: {name}");
        }
        assert!(names(&shader).iter().all(|name| name.starts_with("antumbra_") || name.starts_with("ANTUMBRA_")));
        assert!(shader.spirv().is_ok() && shader.hlsl().is_ok() && shader.msl().is_ok(), "{key:?}");
        // No key pays for it.
        assert!(
            !names(&Shader::parse(&wgsl::library(key).join("\n")).unwrap())
                .iter()
                .any(|name| name.contains("footprint"))
        );
    }
}

/// Shader text without its comments.
fn code_of(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Of the shader below.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Sample {
    view: ViewUniforms,
    position_side: Vec4,
    dx: Vec4,
    dy: Vec4,
}

const SHADER: &str = "
struct Sample { view: AntumbraView, position_side: vec4f, dx: vec4f, dy: vec4f }
@group(0) @binding(0) var<storage, read> samples: array<Sample>;
@group(0) @binding(1) var<storage, read_write> found: array<vec4f>;
@compute @workgroup_size(64) fn run(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&samples) {
        let at = samples[id.x];
        let texels = antumbra_footprint(at.view, at.position_side.w, at.position_side.xyz, at.dx.xyz, at.dy.xyz);
        found[id.x] = vec4f(antumbra_footprint_colour(texels), texels);
    }
}";

/// Points on the ground and on walls of a small scene, in maps of every technique, with the exact texels per pixel and the
/// condition of J.
fn samples() -> Vec<(Sample, f64, f64)> {
    let model = support::boxes();
    let camera = support::camera(UVec2::new(640, 480));
    let origin = camera.eye();
    let bounds = support::bounds(&model);
    let mut samples = Vec::new();
    for (_, technique) in techniques::NAMED {
        let input = FitInput {
            camera,
            light: Light::Directional { travel: support::travel() },
            scene: Scene::within(bounds),
            map: MapBudget::one(1024),
            origin,
            previous: None,
        };
        let frame = Remix { guard: false, ..technique() }.fit(&input).expect("a legal view");
        let view = frame.uniforms.views[0];
        for index in 0..400_u32 {
            let (x, z) = (f64::from(index % 20) - 9.5, f64::from(index / 20) - 9.5);
            let normal = [DVec3::Y, DVec3::new(0.3, 1.0, 0.2).normalize(), DVec3::X][index as usize % 3];
            let position = (DVec3::new(x, 0.1, z) - origin).as_vec3();
            let Some(exact) = footprint_at(&view, 1024, &camera, origin, position.as_dvec3(), normal) else { continue };
            let sight = Sight::new(&camera, origin, position.as_dvec3(), normal);
            let (width, height) = (camera.viewport.x, camera.viewport.y);
            let Projection::Perspective { right, up, .. } = camera.projection else { continue };
            // A thousandth of a pixel, so that the step is along the derivative.
            let steps = [DVec2::X * right / f64::from(width), DVec2::Y * up / f64::from(height)];
            let [dx, dy] = steps.map(|step| (sight.meet(step * 2e-3) * 1e3).as_vec3().extend(0.0));
            let Some(columns) = differences(&view, 1024, &camera, position.as_dvec3(), &sight) else { continue };
            let (least, most, _) = singular(columns);
            samples.push((
                Sample { view, position_side: position.extend(1024.0), dx, dy },
                exact.texels_per_pixel,
                most / least,
            ));
        }
    }
    assert!(samples.len() > 1_500, "{}", samples.len());
    samples
}

fn twin(sample: &Sample) -> f32 {
    let [position, dx, dy] = [sample.position_side, sample.dx, sample.dy].map(Vec4::truncate);
    antumbra_footprint(&sample.view, sample.position_side.w, position, dx, dy)
}

/// f32 against f64: rounding of the map's rows at the point, times the condition of J.
#[test]
fn the_twin_is_near_the_exact_one() {
    let mut worst = 0.0_f64;
    for (sample, exact, condition) in samples() {
        let off = (f64::from(twin(&sample)) / exact - 1.0).abs() / condition;
        worst = worst.max(off);
    }
    println!("texels per pixel differ by at most {worst:.1e} of the largest");
    assert!(worst < 2e-4, "{worst}");
    // Behind the map, outside of it, and without one: none, and grey.
    let (sample, ..) = samples()[0];
    let elsewhere = Sample { position_side: Vec3::splat(1e6).extend(1024.0), ..sample };
    let lit = Sample { view: ViewUniforms::LIT, ..sample };
    for none in [elsewhere, lit] {
        assert_eq!(antumbra_footprint_colour(twin(&none)), Vec3::splat(0.35));
    }
}

#[test]
fn the_shader_agrees_with_its_twin() {
    let Some(gpu) = support::gpu() else { return };
    let samples = samples();
    let input: Vec<Sample> = samples.iter().map(|(sample, ..)| *sample).collect();
    let mut worst = [0.0_f32; 2];
    for ((sample, found), (_, _, condition)) in input.iter().zip(run(&gpu, &input)).zip(&samples) {
        let texels = twin(sample);
        worst[0] = worst[0].max((found.w / texels - 1.0).abs() / *condition as f32);
        worst[1] = worst[1].max((found.truncate() - antumbra_footprint_colour(found.w)).abs().max_element());
    }
    println!("shader and twin differ by at most {:.1e} of the largest, colours by {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 2e-5 && worst[1] < 1e-3, "{worst:?}");
}

/// Runs the shader on the adapter: red, green, blue, texels per pixel.
fn run(gpu: &Gpu, samples: &[Sample]) -> Vec<Vec4> {
    let device = gpu.device();
    // The pipeline.
    let text = [wgsl::library(WgslKey::default()).join("\n").as_str(), wgsl::FOOTPRINT, SHADER].join("\n");
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("footprints"), source });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("footprints"),
        layout: None,
        module: &module,
        entry_point: Some("run"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    // The buffers.
    let size = (size_of::<Vec4>() * samples.len()) as u64;
    let buffer = |size: u64, usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("footprints"),
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let input = buffer(size_of_val(samples) as u64, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST);
    let output = buffer(size, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(size, wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    gpu.queue().write_buffer(&input, 0, bytemuck::cast_slice(samples));
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: input.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
        ],
    });
    // Run.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(samples.len().div_ceil(64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&output, 0, &read, 0, size);
    gpu.queue().submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    bytemuck::pod_collect_to_vec(&read.get_mapped_range(..).unwrap())
}
