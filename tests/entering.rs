//! A large building enters the picture (figure 15 of the thesis): texels of maps that are fitted to the objects in view
//! change at once, those of maps that are fitted to the view do not.

use antumbra::aliasing::footprint_at;
use antumbra::{Aabb, Camera, FitInput, Light, MapBudget, Object, Remix, Scene, ShadowTechnique, techniques};
use glam::{DMat4, DQuat, DVec3};

/// Side of a map, texels.
const SIDE: u32 = 1024;
/// Frames of the path.
const FRAMES: usize = 48;
/// By how much the head turns from frame to frame, radians: 45 degrees a second at 60 Hz.
const TURN: f64 = core::f64::consts::FRAC_PI_4 / 60.0;
/// How deep the picture is, world units.
const FAR: f64 = 150.0;
/// Vertical field of view, radians.
const FOV_Y: f64 = 0.8;
/// Width of the picture over its height.
const ASPECT: f64 = 4.0 / 3.0;
/// Maps of both techniques.
const MAPS: u32 = 3;

/// Ground in tiles, a palm before the eye, and a large building that is outside of the picture at first.
fn objects() -> Vec<Object> {
    let boxed = |centre: [f64; 2], half: f64, height: f64| Object {
        bounds: Aabb::new(
            DVec3::new(centre[0] - half, 0.0, centre[1] - half),
            DVec3::new(centre[0] + half, height, centre[1] + half),
        ),
        casts: true,
    };
    let tiles =
        (-10..10).flat_map(|x| (-10..10).map(move |z| [f64::from(x) * 20.0 + 10.0, f64::from(z) * 20.0 + 10.0]));
    tiles
        .map(|centre| boxed(centre, 10.0, 0.0))
        .chain([boxed([2.0, -22.0], 1.5, 6.0), boxed([95.0, -20.0], 25.0, 80.0)])
        .collect()
}

/// Turns right, towards the building.
fn camera(frame: usize) -> Camera {
    let turn = DQuat::from_rotation_y(-TURN * frame as f64);
    Camera::perspective(DMat4::from_rotation_translation(turn, DVec3::new(0.0, 1.7, 0.0)), FOV_Y, ASPECT, 0.5, FAR)
}

/// Whether any of a box may be in the picture: no side of the frustum has all of it beyond.
fn in_view(camera: &Camera, bounds: &Aabb) -> bool {
    let view_from_world = camera.world_from_view.inverse();
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|bits| {
        let pick = |bit: usize, low: f64, high: f64| if bits & bit == 0 { low } else { high };
        let (min, max) = (bounds.min, bounds.max);
        let corner = DVec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z));
        view_from_world.transform_point3(corner)
    });
    let up = (0.5 * FOV_Y).tan();
    let sides = |at: &DVec3| [at.x, -at.x, at.y * ASPECT, -at.y * ASPECT].map(|along| along > -at.z * up * ASPECT);
    (0..4).all(|side| !corners.iter().all(|at| sides(at)[side])) && corners.iter().any(|at| (0.0..FAR).contains(&-at.z))
}

/// Pixels that a texel covers in the middle of each slice, in each frame: what a technique makes of the scene or, `greedy`, of
/// the objects that are in the picture.
fn texels(remix: &Remix, greedy: bool) -> Vec<Vec<f64>> {
    let all = objects();
    let fit = |frame: usize| {
        let (camera, travel) = (camera(frame), DVec3::new(-0.5, -0.4, 0.4).normalize());
        let seen: Vec<Object> =
            all.iter().filter(|object| !greedy || in_view(&camera, &object.bounds)).copied().collect();
        let bounds = seen.iter().fold(Aabb::EMPTY, |bounds, object| bounds.union(object.bounds));
        let input = FitInput {
            camera,
            light: Light::Directional { travel },
            scene: Scene { objects: &seen, ..Scene::within(bounds) },
            map: MapBudget { side: SIDE, layers: MAPS, views: MAPS },
            origin: camera.eye(),
            previous: None,
        };
        let frame = remix.fit(&input).expect("legal");
        let middle = |view: &antumbra::ViewUniforms| {
            let depth = f64::from(0.5 * (view.domain[0] + view.domain[1].min(FAR as f32)));
            footprint_at(view, SIDE, &camera, camera.eye(), camera.forward() * depth, -travel).expect("in the map").area
        };
        frame.uniforms.views[..frame.views.len()].iter().map(middle).collect()
    };
    (0..FRAMES).map(fit).collect()
}

/// Largest change of any map's texels from frame to frame, as a factor, less one.
fn largest_jump(texels: &[Vec<f64>]) -> f64 {
    let change = |pair: &[Vec<f64>]| {
        assert_eq!(pair[0].len(), MAPS as usize, "every slice has a map");
        pair[0].iter().zip(&pair[1]).map(|(a, b)| (a / b).max(b / a) - 1.0).fold(0.0, f64::max)
    };
    texels.windows(2).map(change).fold(0.0, f64::max)
}

#[test]
fn a_building_that_enters_changes_no_texel_at_once() {
    let greedy = largest_jump(&texels(&techniques::pssm(), true));
    for (name, remix) in [("pssm", techniques::pssm()), ("smra", techniques::smra())] {
        let steady = largest_jump(&texels(&remix, false));
        println!("largest jump of texels: greedy pssm {greedy:.4}, {name} {steady:.4}: {:.4} of it", steady / greedy);
        assert!(steady <= 0.1 * greedy, "{name}: {steady} against {greedy}");
    }
    // The building matters: texels of maps that are fitted to it grow by a third in a single frame.
    assert!(greedy > 0.33, "{greedy}");
}
