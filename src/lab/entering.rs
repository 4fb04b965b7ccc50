//! A large building enters the picture while the head turns (figure 15 of the thesis): texels of maps that are fitted
//! to the objects in view change at once, those of maps that are fitted to the scene need not.
//!
//! # References
//! - J. Abrantes de Oliveira, *Analysis and proposal of a shadow mapping remix approach*: the continuity problem.

use glam::{DMat4, DQuat, DVec3};

use super::serving::serving;
use crate::aliasing::footprint_at;
use crate::camera::Camera;
use crate::error::FitError;
use crate::frame::ShadowFrame;
use crate::light::Light;
use crate::remix::Remix;
use crate::scene::{Aabb, MapBudget, Object, Scene};
use crate::technique::{FitInput, ShadowTechnique};

/// Side of the maps, texels. Jumps hardly depend on it: they are ratios.
pub const SIDE: u32 = 1024;

/// Frames of the path.
pub const FRAMES: usize = 48;

/// By how much the head turns from frame to frame, radians: 45 degrees a second at 60 Hz.
const TURN: f64 = core::f64::consts::FRAC_PI_4 / 60.0;

/// How deep the picture is, world units.
const FAR: f64 = 150.0;

/// Vertical field of view, radians.
const FOV_Y: f64 = 0.8;

/// Width of the picture over its height.
const ASPECT: f64 = 4.0 / 3.0;

/// Eye depths at which texels are looked at, world units: the middle of the picture, octave by octave.
pub const DEPTHS: [f64; 6] = [4.0, 8.0, 16.0, 32.0, 64.0, 128.0];

/// Largest changes from frame to frame of the pixels that a texel covers, as factors less one: 0 is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jumps {
    /// Whichever map serves the place.
    pub any: f64,
    /// Where the same map serves it in both frames.
    pub same_map: f64,
    /// How often one of the places was served by a map in one frame of two, and not in the other: a jump without a
    /// factor. At most [`DEPTHS`] times [`FRAMES`].
    pub gained_or_lost: usize,
}

/// A map, and the pixels that a texel of it covers.
type Served = Option<(usize, f64)>;

/// Jumps in the middle of the picture, at any of the [`DEPTHS`], while the building enters. Each frame knows the one
/// before, as in an engine. `greedy`: maps are fitted to the objects in the picture, as parallel splits were published,
/// instead of the scene.
///
/// # Errors
/// The technique refused one of the frames.
pub fn largest_jumps(remix: &Remix, greedy: bool) -> Result<Jumps, FitError> {
    let all = objects();
    let mut previous: Option<(ShadowFrame, [Served; 6])> = None;
    let mut largest = Jumps::default();
    for frame in 0..FRAMES {
        // Fit to what is there, or to what is seen of it.
        let (camera, travel) = (camera(frame), DVec3::new(-0.5, -0.4, 0.4).normalize());
        let seen: Vec<Object> =
            all.iter().filter(|object| !greedy || in_view(&camera, &object.bounds)).copied().collect();
        let bounds = seen.iter().fold(Aabb::EMPTY, |bounds, object| bounds.union(object.bounds));
        let maps = u32::from(remix.wgsl_key().maps).max(1);
        let fitted = remix.fit(&FitInput {
            camera,
            light: Light::Directional { travel },
            scene: Scene { objects: &seen, ..Scene::within(bounds) },
            map: MapBudget { side: SIDE, layers: maps, views: maps },
            origin: camera.eye(),
            previous: previous.as_ref().map(|(frame, _)| frame),
        })?;
        // Compare with the frame before.
        let now = DEPTHS.map(|depth| texel_at(&fitted, &camera, depth, -travel));
        for (before, now) in previous.iter().flat_map(|(_, before)| before).zip(&now) {
            largest.add(*before, *now);
        }
        previous = Some((fitted, now));
    }
    Ok(largest)
}

impl Jumps {
    /// Takes in what became of a place from one frame to the next.
    fn add(&mut self, before: Served, now: Served) {
        match (before, now) {
            (Some((map_before, a)), Some((map, b))) => {
                let jump = (a / b).max(b / a) - 1.0;
                self.any = self.any.max(jump);
                self.same_map = self.same_map.max(if map == map_before { jump } else { 0.0 });
            }
            (None, None) => {}
            _ => self.gained_or_lost += 1,
        }
    }
}

/// Ground in tiles, a palm before the eye, and a large building that is outside of the picture at first.
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

/// The map that serves a depth, and the pixels that a texel of it covers there, facing the light.
fn texel_at(frame: &ShadowFrame, camera: &Camera, depth: f64, normal: DVec3) -> Served {
    let (at, origin) = (camera.forward() * depth, camera.eye());
    let view = serving(frame, camera, origin, at, normal)?;
    let found = footprint_at(&frame.uniforms.views[view], frame.map.side, camera, origin, at, normal)?;
    Some((view, found.area))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_building_enters_within_the_path() {
        let all = objects();
        let building = all.last().expect("objects").bounds;
        let seen: Vec<bool> = (0..FRAMES).map(|frame| in_view(&camera(frame), &building)).collect();
        assert!(!seen[0] && seen[FRAMES - 1], "{seen:?}");
        assert!(seen.is_sorted(), "it does not leave again: {seen:?}");
        // The palm stays.
        let palm = all[all.len() - 2].bounds;
        assert!((0..FRAMES).all(|frame| in_view(&camera(frame), &palm)));
    }

    #[test]
    fn maps_that_come_and_go_are_counted() {
        let mut jumps = Jumps::default();
        jumps.add(Some((0, 2.0)), Some((0, 3.0)));
        assert_eq!(jumps, Jumps { any: 0.5, same_map: 0.5, gained_or_lost: 0 });
        // Shrinking is a jump as growing is; another map's is none of the same.
        jumps.add(Some((0, 4.0)), Some((1, 2.0)));
        assert_eq!(jumps, Jumps { any: 1.0, same_map: 0.5, gained_or_lost: 0 });
        for [before, now] in [[None, None], [None, Some((0, 1.0))], [Some((1, 1.0)), None]] {
            jumps.add(before, now);
        }
        assert_eq!(jumps, Jumps { any: 1.0, same_map: 0.5, gained_or_lost: 2 });
    }
}
