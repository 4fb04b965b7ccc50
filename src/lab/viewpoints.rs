//! Built-in cameras and suns for the built-in scenes, and paths along which the camera moves as a person would move it.
//!
//! Each scene has the cases that separate techniques: the sun across the view (warps at their best), the sun ahead
//! (duelling frusta, warps of no use), a close-up (resolution), and an overview with the sun behind.

use std::f64::consts::{FRAC_PI_4, TAU};

use glam::{DQuat, DVec3};

use super::sparse_city::FIGURE;

/// A camera and a directional light.
#[derive(Clone, Debug, PartialEq)]
pub struct Viewpoint {
    /// Name in reports and files: lower case, words joined by `-`, the scene first.
    pub name: String,
    /// Position of the eye, world units.
    pub eye: DVec3,
    /// A point in the middle of the picture, world units, apart from `eye`.
    pub target: DVec3,
    /// Which way is up in the picture; unit length, not along the view.
    pub up: DVec3,
    /// Vertical field of view, radians, 0 to pi.
    pub fov_y: f64,
    /// Eye depth of the near plane, world units, > 0.
    pub near: f64,
    /// Eye depth of the far plane, world units, > `near`.
    pub far: f64,
    /// Direction in which light travels, unit length.
    pub travel: DVec3,
    /// Eye depth up to which shadows are wanted, world units, > `near`, at most `far`.
    pub shadow_distance: f64,
}

/// Ways to move the camera of a viewpoint; the light stays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathKind {
    /// Forward along the view at a walk.
    Dolly,
    /// The eye stays, the head turns left about `up`.
    Turn,
    /// Around the target at a walk, facing it.
    Orbit,
}

/// Frames per second of a path.
const FRAME_RATE: f64 = 60.0;

/// Speed of a walk, m/s (people prefer 1.4). Slower hides flicker; much faster hides it under motion.
const WALK: f64 = 1.4;

/// How fast a head turns to look around, radians/s: 45 degrees, leisurely.
const HEAD_TURN: f64 = FRAC_PI_4;

/// The dolly stops at this share of the distance to the target, before the eye enters what it looks at.
const CLOSEST: f64 = 0.25;

/// Viewpoints of [`super::treeline::treeline`]; the planes and the field of view are the thesis'.
#[must_use]
pub fn treeline_viewpoints() -> Vec<Viewpoint> {
    let view = |name: &str, eye: [f64; 3], target: [f64; 3], sun: [f64; 2]| Viewpoint {
        name: format!("treeline-{name}"),
        eye: DVec3::from(eye),
        target: DVec3::from(target),
        up: DVec3::Y,
        fov_y: FRAC_PI_4,
        near: 1.0,
        far: 50.0,
        travel: sunlight(sun[0], sun[1]),
        shadow_distance: 50.0,
    };
    vec![
        view("across", [-16.5, 1.8, 5.2], [-2.0, 2.3, 0.3], [-161.0, 47.0]),
        view("ahead", [-2.4, 1.8, 17.5], [0.3, 2.6, 0.0], [172.0, 30.0]),
        view("close", [2.3, 1.7, 3.9], [0.3, 0.75, -0.6], [-118.0, 50.0]),
        view("overview", [-13.0, 9.5, 18.0], [0.4, 1.6, 0.0], [-22.0, 42.0]),
        view("facade", [0.5, 1.9, 19.6], [0.0, 3.2, 0.0], [100.0, 40.0]),
    ]
}

/// Viewpoints of [`super::sparse_city::sparse_city`]; the planes and the field of view are the thesis'.
#[must_use]
pub fn sparse_city_viewpoints() -> Vec<Viewpoint> {
    let view = |name: &str, eye: DVec3, target: DVec3, sun: [f64; 2]| Viewpoint {
        name: format!("sparse-city-{name}"),
        eye,
        target,
        up: DVec3::Y,
        fov_y: FRAC_PI_4,
        near: 15.0,
        far: 5_000.0,
        travel: sunlight(sun[0], sun[1]),
        shadow_distance: 5_000.0,
    };
    vec![
        view("across", DVec3::new(88.0, 42.0, 330.0), DVec3::new(66.0, 16.0, 0.0), [-82.0, 33.0]),
        view("ahead", DVec3::new(86.0, 30.0, 262.0), DVec3::new(70.0, 12.0, -60.0), [174.0, 24.0]),
        view("figure", FIGURE + DVec3::new(-8.0, 9.3, 20.0), FIGURE + DVec3::new(0.8, 6.0, 0.0), [-70.0, 38.0]),
        view("overview", DVec3::new(-640.0, 360.0, 780.0), DVec3::new(-40.0, 0.0, 60.0), [-18.0, 40.0]),
    ]
}

/// Viewpoints on which the thesis is put to the test: those of the scene, and ordinary ones to make at least six.
///
/// Empty for a scene that is not built in.
#[must_use]
pub fn thesis_viewpoints(scene: &str) -> Vec<Viewpoint> {
    let (mut views, further) = match scene {
        "treeline" => (treeline_viewpoints(), vec![("evening", [13.0, 2.0, 8.5], [0.0, 1.9, 0.0], [-75.0, 22.0])]),
        "sparse-city" => (
            sparse_city_viewpoints(),
            vec![
                ("plaza", [-46.0, 24.0, 78.0], [10.0, 4.0, 0.0], [118.0, 44.0]),
                ("roofs", [340.0, 150.0, -420.0], [-20.0, 10.0, 0.0], [62.0, 30.0]),
            ],
        ),
        _ => return Vec::new(),
    };
    for (name, eye, target, [azimuth, elevation]) in further {
        let (eye, target) = (DVec3::from(eye), DVec3::from(target));
        let (name, travel) = (format!("{scene}-{name}"), sunlight(azimuth, elevation));
        views.push(Viewpoint { name, eye, target, travel, ..views[0].clone() });
    }
    views
}

/// The way light travels from a sun at `elevation` above the horizon, `azimuth` from +z towards +x; degrees, because
/// these are written by hand.
fn sunlight(azimuth: f64, elevation: f64) -> DVec3 {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let (up, level) = elevation.to_radians().sin_cos();
    -DVec3::new(sin * level, up, cos * level)
}

/// `frames` viewpoints from `start` on (which is the first of them), 1/60 s apart, named `start-kind-0000` and so on.
#[must_use]
pub fn path(kind: PathKind, start: &Viewpoint, frames: usize) -> Vec<Viewpoint> {
    (0..frames).map(|frame| moved(kind, start, frame)).collect()
}

fn moved(kind: PathKind, start: &Viewpoint, frame: usize) -> Viewpoint {
    let seconds = frame as f64 / FRAME_RATE;
    let to_target = start.target - start.eye;
    let distance = to_target.length();
    let about_up = |angle: f64| DQuat::from_axis_angle(start.up.normalize(), angle);
    let (kind, eye, target) = match kind {
        PathKind::Dolly => {
            let walked = (WALK * seconds).min(distance * (1.0 - CLOSEST));
            ("dolly", start.eye + to_target * (walked / distance), start.target)
        }
        PathKind::Turn => ("turn", start.eye, start.eye + about_up((HEAD_TURN * seconds) % TAU) * to_target),
        PathKind::Orbit => {
            // The angle per second that makes a walk around the target's axis
            let radius = to_target.reject_from_normalized(start.up.normalize()).length().max(start.near);
            ("orbit", start.target - about_up((WALK / radius * seconds) % TAU) * to_target, start.target)
        }
    };
    Viewpoint { name: format!("{}-{kind}-{frame:04}", start.name), eye, target, ..start.clone() }
}

#[cfg(test)]
mod tests {
    use glam::dcamera::rh::{proj::directx::perspective, view::look_to_mat4};

    use super::*;
    use crate::lab::raster::{DepthMode, DepthTarget, NONE, RasterPass, rasterise};
    use crate::lab::{sparse_city::sparse_city, treeline::treeline};

    fn all() -> Vec<Viewpoint> {
        [thesis_viewpoints("treeline"), thesis_viewpoints("sparse-city")].concat()
    }

    /// Cosine between the level parts of view and light.
    fn level_cosine(view: &Viewpoint) -> f64 {
        let level = |v: DVec3| v.reject_from_normalized(DVec3::Y).normalize();
        level(view.target - view.eye).dot(level(view.travel))
    }

    #[test]
    fn viewpoints_are_legal_and_named_once() {
        let mut names: Vec<String> = all().iter().map(|view| view.name.clone()).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), all().len());
        for view in all() {
            assert!(view.travel.is_normalized() && view.travel.y < 0.0, "{}: {}", view.name, view.travel);
            assert!(0.0 < view.near && view.near < view.shadow_distance && view.shadow_distance <= view.far);
            assert!((view.target - view.eye).normalize().cross(view.up).length() > 0.1, "{}", view.name);
        }
    }

    #[test]
    fn the_thesis_is_tested_on_six_viewpoints_a_scene() {
        assert_eq!(["treeline", "sparse-city"].map(|scene| thesis_viewpoints(scene).len()), [6; 2]);
        assert!(thesis_viewpoints("treeline").starts_with(&treeline_viewpoints()));
        assert!(thesis_viewpoints("sparse-city").starts_with(&sparse_city_viewpoints()));
        assert!(thesis_viewpoints("elsewhere").is_empty());
    }

    #[test]
    fn viewpoints_stand_in_the_open_and_see_much() {
        const SIZE: [u32; 2] = [160, 120];
        let scenes = [(treeline(), thesis_viewpoints("treeline")), (sparse_city(), thesis_viewpoints("sparse-city"))];
        for (scene, view) in scenes.iter().flat_map(|(scene, views)| views.iter().map(move |view| (scene, view))) {
            let projection = perspective(view.fov_y, 4.0 / 3.0, view.near, view.far);
            let clip = projection * look_to_mat4(DVec3::ZERO, (view.target - view.eye).normalize(), view.up);
            let pass = RasterPass { clip_from_render: clip.as_mat4(), depth_from_render: None, origin: view.eye };
            let mut target = DepthTarget::new(SIZE[0], SIZE[1], DepthMode::LessEqual);
            rasterise(&mut target, scene, &scene.objects, &pass);

            let mut objects: Vec<usize> = target
                .triangle
                .iter()
                .filter(|&&triangle| triangle != NONE)
                .map(|&triangle| scene.objects.partition_point(|object| object.end <= triangle as usize))
                .collect();
            let share = objects.len() as f64 / target.triangle.len() as f64;
            objects.sort_unstable();
            objects.dedup();
            assert!((0.4..0.95).contains(&share), "{}: {share} of the picture shows the scene", view.name);
            assert!(objects.len() >= 12, "{}: {} objects in sight", view.name, objects.len());

            // The lowest row shows ground: the near plane must not cut it off
            let lowest = target.triangle.iter().rev().take(SIZE[0] as usize);
            assert!(lowest.clone().all(|&triangle| triangle != NONE), "{}: the near plane shows", view.name);
        }
    }

    #[test]
    fn suns_stand_where_the_names_say() {
        for view in all() {
            let cosine = level_cosine(&view);
            let legal = match view.name.rsplit('-').next().unwrap() {
                "across" => -0.2..0.2,
                "ahead" => -1.01..-0.9,
                "overview" => 0.7..1.01,
                _ => -1.01..1.01,
            };
            assert!(legal.contains(&cosine), "{}: cosine {cosine}", view.name);
        }
    }

    #[test]
    fn paths_start_at_the_viewpoint_and_move_at_human_speed() {
        for start in all() {
            for kind in [PathKind::Dolly, PathKind::Turn, PathKind::Orbit] {
                let frames = path(kind, &start, 61);
                assert!(frames[0].eye.distance(start.eye) < 1e-9 && frames[0].target.distance(start.target) < 1e-9);
                let walked: f64 = frames.windows(2).map(|pair| pair[0].eye.distance(pair[1].eye)).sum();
                let turned = (frames[60].target - frames[60].eye).angle_between(start.target - start.eye);
                match kind {
                    PathKind::Turn => assert!(walked < 1e-9 && (0.6..0.8).contains(&turned), "turned {turned}"),
                    _ => assert!((walked - WALK).abs() < 0.01, "{kind:?} of {}: {walked} m", start.name),
                }
            }
        }
    }

    #[test]
    fn a_dolly_never_reaches_its_target() {
        let start = &treeline_viewpoints()[2];
        let last = path(PathKind::Dolly, start, 10_000).pop().unwrap();
        let share = last.eye.distance(start.target) / start.eye.distance(start.target);
        assert!((share - CLOSEST).abs() < 1e-9, "stopped at {share} of the way");
    }
}
