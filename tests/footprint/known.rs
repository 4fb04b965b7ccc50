//! Values that are known without the crate, limits, and inputs that have no footprint.

use antumbra::aliasing::{Spread, footprint_at, perspective_at, perspective_spread};
use antumbra::warp::Warp;
use antumbra::{
    Aabb, Camera, FitInput, Light, MapBudget, Projection, Remix, Scene, ShadowFrame, ShadowTechnique, ViewUniforms,
};
use glam::{DVec3, UVec2};

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

/// The table of E(z), the error along the view of a map seen level under light from above, and the storage S = `M_s`
/// `M_t` of uniform (9900) and perspective (99) warps at a ratio of depths of 100: MATH.md section 8.
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
