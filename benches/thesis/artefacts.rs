//! A number for each class of artefact in the thesis's Table 1.

use antumbra::aliasing::{Spread, footprint_at};
use antumbra::lab::truth::Truth;
use antumbra::{Aabb, Camera, FitInput, Light, MapBudget, Object, Remix, Scene, Select, ShadowFrame, ShadowTechnique};
use glam::{DMat4, DQuat, DVec3, Vec3};

/// Cosine of the angle to the light (80°) from which a surface counts as grazed. The thesis's rule begins at 85°: a
/// wider band holds more pixels and what lies just beside that rule.
const GRAZED: f32 = 0.173_648_18;

/// What shows in one picture.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Artefacts {
    /// Perspective aliasing: pixels per texel that half of what is seen has at most, and 19 in 20.
    pub(crate) perspective: [f64; 2],
    /// Projection aliasing: sum of |error| over grazed pixels, and their number.
    pub(crate) grazed: [f64; 2],
    /// Binary edges: pixels that an edge passes through, those of them that are grey, and the sum of squared errors.
    pub(crate) edges: [f64; 3],
}

impl Artefacts {
    pub(crate) fn of(mask: &[u8], truth: &Truth, travel: DVec3, perspective: Option<Spread>) -> Self {
        let to_light = -travel.as_vec3();
        let mut found =
            Self { perspective: perspective.map_or([f64::NAN; 2], |s| [s.median, s.high]), ..Self::default() };
        for (pixel, byte) in mask.iter().enumerate().filter(|(pixel, _)| truth.valid[*pixel]) {
            let area = truth.area[pixel];
            let error = f64::from(f32::from(*byte) / f32::from(u8::MAX) - area);
            if Vec3::from(truth.normal[pixel]).dot(to_light) < GRAZED {
                found.grazed[0] += error.abs();
                found.grazed[1] += 1.0;
            }
            if area > 0.0 && area < 1.0 {
                found.edges[0] += 1.0;
                found.edges[1] += f64::from(u8::from((1..u8::MAX).contains(byte)));
                found.edges[2] += error * error;
            }
        }
        found
    }
}

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
/// Eye depths at which texels are looked at, world units: the middle of the picture, octave by octave.
const DEPTHS: [f64; 6] = [4.0, 8.0, 16.0, 32.0, 64.0, 128.0];

/// Ground in tiles, a palm before the eye, and a large building that is outside of the picture at first: figure 15 of
/// the thesis.
fn objects() -> Vec<Object> {
    let boxed = |centre: [f64; 2], half: f64, height: f64| Object {
        bounds: Aabb::new(
            DVec3::new(centre[0] - half, 0.0, centre[1] - half),
            DVec3::new(centre[0] + half, height, centre[1] + half),
        ),
        casts: true,
    };
    let tile = |x: i32, z: i32| boxed([f64::from(x) * 20.0 + 10.0, f64::from(z) * 20.0 + 10.0], 10.0, 0.0);
    let tiles = (-10..10).flat_map(|x| (-10..10).map(move |z| tile(x, z)));
    tiles.chain([boxed([2.0, -22.0], 1.5, 6.0), boxed([95.0, -20.0], 25.0, 80.0)]).collect()
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

/// Largest changes from frame to frame of the pixels that a texel covers, as factors less one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Jumps {
    /// Whichever map serves the place.
    pub(crate) any: f64,
    /// Where the same map serves it in both frames.
    pub(crate) same_map: f64,
}

/// A map, and the pixels that a texel of it covers.
type Served = Option<(usize, f64)>;

/// Jumps in the middle of the picture, at any of the depths, while the building enters. Each frame knows the one
/// before, as in an engine. `greedy`: maps are fitted to the objects in the picture, as parallel splits were published,
/// instead of the scene.
pub(crate) fn largest_jumps(remix: &Remix, greedy: bool) -> Result<Jumps, String> {
    let all = objects();
    let mut previous: Option<(ShadowFrame, [Served; 6])> = None;
    let mut largest = Jumps::default();
    for frame in 0..FRAMES {
        let (camera, travel) = (camera(frame), DVec3::new(-0.5, -0.4, 0.4).normalize());
        let seen: Vec<Object> =
            all.iter().filter(|object| !greedy || in_view(&camera, &object.bounds)).copied().collect();
        let bounds = seen.iter().fold(Aabb::EMPTY, |bounds, object| bounds.union(object.bounds));
        let maps = u32::from(remix.wgsl_key().maps).max(1);
        let input = FitInput {
            camera,
            light: Light::Directional { travel },
            scene: Scene { objects: &seen, ..Scene::within(bounds) },
            map: MapBudget { side: SIDE, layers: maps, views: maps },
            origin: camera.eye(),
            previous: previous.as_ref().map(|(frame, _)| frame),
        };
        let fitted = remix.fit(&input).map_err(|error| error.to_string())?;
        let now = DEPTHS.map(|depth| texel_at(&fitted, &camera, depth, -travel));
        let before = previous.iter().flat_map(|(_, before)| before).zip(&now);
        for ((map_before, a), (map, b)) in before.filter_map(|(a, b)| a.zip(*b)) {
            let jump = (a / b).max(b / a) - 1.0;
            largest.any = largest.any.max(jump);
            largest.same_map = largest.same_map.max(if map == map_before { jump } else { 0.0 });
        }
        previous = Some((fitted, now));
    }
    Ok(largest)
}

/// The map that serves a depth, and the pixels that a texel of it covers there, facing the light.
fn texel_at(frame: &ShadowFrame, camera: &Camera, depth: f64, normal: DVec3) -> Served {
    let views = &frame.uniforms.views[..frame.views.len()];
    let serves = |index: usize| {
        let [near, far] = frame.views[index].domain.map(f64::from);
        frame.wgsl.select == Select::Finest || frame.views.len() == 1 || (near..=far).contains(&depth)
    };
    let at = camera.forward() * depth;
    let found = |index: usize| {
        let point = footprint_at(&views[index], frame.map.side, camera, camera.eye(), at, normal)?;
        Some((index, point.area))
    };
    (0..views.len()).filter(|index| serves(*index)).find_map(found)
}
