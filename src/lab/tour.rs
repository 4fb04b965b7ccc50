//! Viewpoints for scenes that come without any: around the bounds, with the sun where it separates techniques.

use glam::DVec3;

use super::viewpoints::Viewpoint;
use crate::scene::Aabb;

/// A viewpoint relative to the scene: lengths in radii of its bounds.
struct Stop {
    name: &'static str,
    /// Direction from the middle to the eye: azimuth from +z towards +x, and elevation, degrees.
    eye: [f64; 2],
    /// Distance of the eye from the middle.
    distance: f64,
    /// Where the sun stands: azimuth relative to the eye's, and elevation, degrees.
    sun: [f64; 2],
}

/// The sun across the view, the sun ahead, and close up. Nearer eyes stand inside most scenes; farther ones see ants.
const STOPS: [Stop; 3] = [
    Stop { name: "across", eye: [25.0, 18.0], distance: 1.3, sun: [90.0, 42.0] },
    Stop { name: "ahead", eye: [140.0, 14.0], distance: 1.1, sun: [172.0, 30.0] },
    Stop { name: "close", eye: [250.0, 25.0], distance: 0.5, sun: [-60.0, 50.0] },
];

/// Vertical field of view, radians: the thesis's 45°.
const FIELD_OF_VIEW: f64 = std::f64::consts::FRAC_PI_4;

/// Near plane, in distances from the eye to the middle. Nearer wastes depth; farther cuts what stands close to the eye.
const NEAR: f64 = 0.01;

/// Viewpoints around a scene, y up, named after it.
#[must_use]
pub fn around(scene: &str, bounds: &Aabb) -> Vec<Viewpoint> {
    let middle = bounds.centre();
    // A flat or long scene is looked at over its middle, not from its far end.
    let radius = bounds.half_size().length().max(f64::MIN_POSITIVE);
    let stop = |stop: &Stop| {
        let [azimuth, elevation] = stop.eye;
        let distance = stop.distance * radius;
        Viewpoint {
            name: format!("{scene}-{}", stop.name),
            eye: middle + towards(azimuth, elevation) * distance,
            target: middle,
            up: DVec3::Y,
            fov_y: FIELD_OF_VIEW,
            near: NEAR * distance,
            far: distance + 2.0 * radius,
            travel: -towards(azimuth + stop.sun[0], stop.sun[1]),
            shadow_distance: distance + 2.0 * radius,
        }
    };
    STOPS.iter().map(stop).collect()
}

/// The unit vector at an azimuth from +z towards +x and an elevation, degrees.
fn towards(azimuth: f64, elevation: f64) -> DVec3 {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let (up, level) = elevation.to_radians().sin_cos();
    DVec3::new(sin * level, up, cos * level)
}
