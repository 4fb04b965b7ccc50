//! What several test files need: an adapter or a stated reason to do without, and a small scene.
#![allow(dead_code, reason = "each test file uses a part of it")]

pub(crate) mod compute;

use std::path::PathBuf;

use antumbra::lab::case::{Case, CaseCamera, CaseLight};
use antumbra::lab::comparison::{shared_case_files, shared_scenes};
use antumbra::lab::gpu::Gpu;
use antumbra::lab::scene::{Cutout, SOLID, SceneModel};
use antumbra::{Aabb, Camera};
use glam::{DVec2, DVec3, UVec2};

/// The adapter. Without one the test fails, unless `ANTUMBRA_NO_GPU=1` says that none is to be expected.
pub(crate) fn gpu() -> Option<Gpu> {
    match Gpu::new() {
        Ok(gpu) => {
            // `tests/run` counts these lines, by the names of tests without their modules.
            let thread = std::thread::current();
            let test = thread.name().and_then(|path| path.rsplit("::").next()).unwrap_or("test");
            println!("GPU test: {test} on {}", gpu.adapter());
            Some(gpu)
        }
        Err(error) if std::env::var("ANTUMBRA_NO_GPU").as_deref() == Ok("1") => {
            eprintln!("SKIPPED, because ANTUMBRA_NO_GPU=1: {error}");
            None
        }
        Err(error) => panic!("{error}; set ANTUMBRA_NO_GPU=1 to skip what needs an adapter"),
    }
}

/// A square of ground at height 0 and boxes on it; the last box floats, and one fence is a cut-out.
pub(crate) fn boxes() -> SceneModel {
    let mut model = SceneModel { name: "boxes".into(), ..SceneModel::default() };
    quad(&mut model, [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)].map(|(x, z)| DVec3::new(x, 0.0, z)));
    for (centre, half) in [
        (DVec3::new(0.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0)),
        (DVec3::new(-4.0, 1.5, 2.0), DVec3::new(0.5, 1.5, 0.5)),
        (DVec3::new(3.0, 0.5, -4.0), DVec3::new(2.0, 0.5, 0.3)),
        (DVec3::new(4.0, 2.5, 3.0), DVec3::new(1.0, 0.25, 1.0)),
    ] {
        cuboid(&mut model, centre, half);
    }
    fence(&mut model);
    model
}

/// Bounds of a model's positions.
pub(crate) fn bounds(model: &SceneModel) -> Aabb {
    Aabb::around(model.positions.iter().copied())
}

/// A camera that sees the boxes.
pub(crate) fn camera(size: UVec2) -> Camera {
    let world_from_view = Camera::look_at(DVec3::new(7.0, 6.0, 11.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y);
    let aspect = f64::from(size.x) / f64::from(size.y);
    let mut camera = Camera::perspective(world_from_view, 0.9, aspect, 0.1, 100.0);
    camera.viewport = size;
    camera
}

/// The direction in which light travels in these tests.
pub(crate) fn travel() -> DVec3 {
    DVec3::new(0.6, -1.0, 0.35).normalize()
}

fn quad(model: &mut SceneModel, corners: [DVec3; 4]) {
    let first = model.positions.len() as u32;
    let triangle = model.triangles.len();
    model.positions.extend(corners);
    model.uvs.extend([DVec2::new(0.0, 1.0), DVec2::new(1.0, 1.0), DVec2::new(1.0, 0.0), DVec2::ZERO]);
    model.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    model.triangle_cutout.extend([SOLID; 2]);
    model.objects.push(triangle..triangle + 2);
}

fn cuboid(model: &mut SceneModel, centre: DVec3, half: DVec3) {
    let start = model.triangles.len();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut along = [DVec3::ZERO; 3];
            for (slot, direction) in along.iter_mut().enumerate() {
                direction[(axis + slot) % 3] = half[(axis + slot) % 3];
            }
            let [out, a, b] = [along[0] * sign, along[1], along[2] * sign];
            quad(model, [out - a - b, out + a - b, out + a + b, out - a + b].map(|corner| centre + corner));
            model.objects.pop();
        }
    }
    model.objects.push(start..model.triangles.len());
}

/// An upright square whose left half (u < ½) is holes.
fn fence(model: &mut SceneModel) {
    let corners = [(-8.0, 0.0), (-6.0, 0.0), (-6.0, 2.0), (-8.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    quad(model, corners);
    let count = model.triangle_cutout.len();
    model.triangle_cutout[count - 2..].fill(0);
    let alpha = (0..64).map(|texel| if texel % 8 < 4 { 0 } else { 255 }).collect();
    model.cutouts.push(Cutout { width: 8, height: 8, alpha, cutoff: 0.5 });
}

/// Distance along a ray to the nearest triangle beyond `after`, with the triangle: every one is tried.
pub(crate) fn trace(model: &SceneModel, from: DVec3, along: DVec3, after: f64) -> Option<(f64, usize)> {
    let mut nearest: Option<(f64, usize)> = None;
    for (index, triangle) in model.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|vertex| model.positions[vertex as usize]);
        let Some((distance, u, v)) = hit(from, along, a, b, c) else { continue };
        if distance <= after || nearest.is_some_and(|(best, _)| distance >= best) || is_hole(model, index, u, v) {
            continue;
        }
        nearest = Some((distance, index));
    }
    nearest
}

/// Möller and Trumbore: distance and barycentric coordinates.
fn hit(from: DVec3, along: DVec3, a: DVec3, b: DVec3, c: DVec3) -> Option<(f64, f64, f64)> {
    let (ab, ac) = (b - a, c - a);
    let cross = along.cross(ac);
    let determinant = ab.dot(cross);
    if determinant.abs() < 1e-14 {
        return None;
    }
    let to = from - a;
    let u = to.dot(cross) / determinant;
    let other = to.cross(ab);
    let v = along.dot(other) / determinant;
    let distance = ac.dot(other) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some((distance, u, v))
}

/// The fence's mask is a step at u = ½; nearest texel is as good as bilinear away from it.
fn is_hole(model: &SceneModel, triangle: usize, u: f64, v: f64) -> bool {
    let Some(cutout) = model.cutouts.get(model.triangle_cutout[triangle] as usize) else { return false };
    let [a, b, c] = model.triangles[triangle].map(|vertex| model.uvs[vertex as usize]);
    let at = a + (b - a) * u + (c - a) * v;
    let texel = |t: f64, side: u32| ((t.rem_euclid(1.0) * f64::from(side)) as u32).min(side - 1);
    let alpha = cutout.alpha[(texel(at.y, cutout.height) * cutout.width + texel(at.x, cutout.width)) as usize];
    f32::from(alpha) / 255.0 < cutout.cutoff
}

/// A camera and a sun (its `travel` of any length) over geometry that a test makes; shadows as far as the camera sees.
pub(crate) fn case_over(camera: CaseCamera, travel: DVec3, viewport: [u32; 2]) -> Case {
    let case = Case {
        name: "made here".into(),
        scene: "made here".into(),
        camera,
        light: CaseLight::Directional { travel: travel.normalize() },
        viewport,
        shadow_distance: camera.far,
        folder: PathBuf::new(),
    };
    case.check().unwrap_or_else(|error| panic!("{error}"))
}

/// What the manual says of a measurement is what is measured, so that it cannot go stale unnoticed.
pub(crate) fn as_quoted(what: &str, measured: f64, quoted: f64, within: f64) {
    assert!((measured - quoted).abs() <= within, "{what}: {measured}, and README.md says {quoted} (± {within})");
}

/// The folder of the third-party scenes, beside which their cases lie in `../cases`; none, said aloud, where
/// `ANTUMBRA_SCENES` does not name it.
pub(crate) fn scenes() -> Option<PathBuf> {
    let scenes = shared_scenes();
    if scenes.is_none() {
        let thread = std::thread::current();
        println!("SKIPPED {}: ANTUMBRA_SCENES does not name the shared scenes", thread.name().unwrap_or("test"));
    }
    scenes
}

/// The shared case files; none where there are no scenes.
pub(crate) fn shared_cases() -> Vec<PathBuf> {
    scenes().map_or_else(Vec::new, |_| shared_case_files().unwrap_or_else(|error| panic!("{error}")))
}
