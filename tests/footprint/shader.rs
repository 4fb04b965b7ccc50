//! The debug view for shaders: its text, its twin in f32, and the adapter.

use antumbra::aliasing::footprint_at;
use antumbra::encoding::footprint::{antumbra_footprint, antumbra_footprint_colour};
use antumbra::transpile::Shader;
use antumbra::{
    FitInput, Light, MapBudget, Projection, Remix, Scene, ShadowTechnique, ViewUniforms, WgslKey, techniques, wgsl,
};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, UVec2, Vec3, Vec4};

use crate::keys::chosen;
use crate::sight::{Sight, differences, singular};
use crate::support;
use crate::support::compute::compute;

/// The fragment keeps the contract of the library, behind every kind of key.
#[test]
fn the_fragment_keeps_the_contract() {
    for word in
        ["#", "@", "override", "dpdx(", "dpdy(", "fwidth", "textureSample", "loop", "for ", "while", "ptr<", "__"]
    {
        assert!(!code_of(wgsl::FOOTPRINT).contains(word), "{word}");
    }
    for key in chosen() {
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

/// Points on the ground and on walls of a small scene, in maps of every technique, with the exact texels per pixel and
/// the condition of J.
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
    // Red, green, blue, texels per pixel.
    let text = [wgsl::library(WgslKey::default()).join("\n").as_str(), wgsl::FOOTPRINT, SHADER].join("\n");
    let found: Vec<Vec4> = compute(&gpu, &text, &input, &[]);
    let mut worst = [0.0_f32; 2];
    for ((sample, found), (_, _, condition)) in input.iter().zip(found).zip(&samples) {
        let texels = twin(sample);
        worst[0] = worst[0].max((found.w / texels - 1.0).abs() / *condition as f32);
        worst[1] = worst[1].max((found.truncate() - antumbra_footprint_colour(found.w)).abs().max_element());
    }
    println!("shader and twin differ by at most {:.1e} of the largest, colours by {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 2e-5 && worst[1] < 1e-3, "{worst:?}");
}
