//! The blur of a picture's shadow term: what it keeps, how wide it is, and the passes against their twin.

mod adapter;
mod picture;
#[path = "../support/mod.rs"]
mod support;

use antumbra::encoding::eye_blur::{EyeBlur, antumbra_eye_blur_deviation, antumbra_eye_depth};
use antumbra::lab::eye_blur::blur;
use glam::{DMat4, DVec4, UVec2};

/// A reversed projection without a far plane: depth is `NEAR` over eye depth.
fn reversed(fov_y: f64, aspect: f64) -> DMat4 {
    let y = 1.0 / (0.5 * fov_y).tan();
    DMat4::from_cols(DVec4::X * (y / aspect), DVec4::Y * y, DVec4::NEG_W, DVec4::Z * NEAR)
}

/// Eye depth of the near plane, world units.
const NEAR: f64 = 0.1;

/// Vertical field of view of the cameras here, radians.
const FOV_Y: f64 = 0.9;

/// A picture.
const SIZE: UVec2 = UVec2::new(192, 144);

/// World units over a pixel at an eye depth.
fn pixel(eye_depth: f64) -> f64 {
    2.0 * (0.5 * FOV_Y).tan() * eye_depth / f64::from(SIZE.y)
}

fn camera() -> DMat4 {
    reversed(FOV_Y, f64::from(SIZE.x) / f64::from(SIZE.y))
}

/// What a picture of numbers by column and row is.
fn of(value: impl Fn(u32, u32) -> f64) -> Vec<f32> {
    (0..SIZE.x * SIZE.y).map(|index| value(index % SIZE.x, index / SIZE.x) as f32).collect()
}

/// The depth buffer of eye depths.
fn depths(eye_depth: impl Fn(u32, u32) -> f64) -> Vec<f32> {
    of(|x, y| NEAR / eye_depth(x, y))
}

fn blurred(settings: &EyeBlur, mask: &[f32], depth: &[f32]) -> Vec<f32> {
    let uniforms = settings.uniforms(&camera(), SIZE).expect("legal settings");
    blur(&uniforms, settings.iterations, SIZE, mask, depth)
}

/// Whatever the depths are: a slope, steps, noise and nothing at all.
#[test]
fn a_constant_stays() {
    let settings = EyeBlur { radius: 0.3, iterations: 16, ..EyeBlur::default() };
    let noise = |x: u32, y: u32| f64::from((x * 7919 + y * 104_729) % 97);
    let scenes = [
        depths(|x, y| 2.0 + 0.05 * f64::from(x + y)),
        depths(|x, _| if x < 70 { 3.0 } else { 30.0 }),
        depths(|x, y| 1.0 + noise(x, y)),
        of(|_, _| 0.0),
    ];
    for depth in scenes {
        for value in [0.0, 0.3, 1.0] {
            let result = blurred(&settings, &of(|_, _| value), &depth);
            let worst = result.iter().map(|found| (f64::from(*found) - value).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-5, "{value}: {worst}");
        }
    }
}

/// Shadow before light: each stays what it is across an edge of depth, and mixes where there is none.
#[test]
fn nothing_crosses_an_edge_of_depth() {
    let settings = EyeBlur { radius: 0.2, iterations: 16, ..EyeBlur::default() };
    let edge = f64::from(settings.edge * settings.radius);
    let mask = of(|x, _| f64::from(u8::from(x >= 96)));
    let stepped = |step: f64| depths(move |x, _| if x < 96 { 5.0 } else { 5.0 + step });
    let change = |depth: &[f32]| {
        let result = blurred(&settings, &mask, depth);
        result.iter().zip(&mask).map(|(after, before)| (after - before).abs()).fold(0.0, f32::max)
    };
    assert!(change(&stepped(1.05 * edge)) < 1e-6);
    assert!(change(&stepped(0.95 * edge)) > 0.4);
    // Sky beside a surface, which is nowhere in depth.
    assert!(change(&of(|x, _| if x < 96 { NEAR / 5.0 } else { 0.0 })) < 1e-6);
}

/// Deviation of a line one pixel wide after the blur, pixels: its profile along the row in the middle.
fn deviation(settings: &EyeBlur, eye_depth: f64) -> f64 {
    let mask = of(|x, _| f64::from(u8::from(x == 96)));
    let result = blurred(settings, &mask, &depths(|_, _| eye_depth));
    let row = &result[(SIZE.x * (SIZE.y / 2)) as usize..][..SIZE.x as usize];
    let moment = |power: i32| -> f64 {
        row.iter().enumerate().map(|(x, value)| f64::from(*value) * (x as f64 - 96.0).powi(power)).sum()
    };
    assert!((moment(0) - 1.0).abs() < 1e-4, "a line keeps its weight");
    (moment(2) / moment(0)).sqrt()
}

/// As wide in the world near and far, as long as it is wider than half a pixel and narrower than its bound.
#[test]
fn width_is_the_same_in_the_world() {
    let settings = EyeBlur { radius: 0.1, most: 10.0, ..EyeBlur::default() };
    println!("| eye depth | pixels | deviation, world units |\n|--:|--:|--:|");
    for eye_depth in [1.6, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 30.0] {
        let pixels = deviation(&settings, eye_depth);
        let world = pixels * pixel(eye_depth);
        println!("| {eye_depth} | {pixels:.2} | {world:.4} |");
        assert!((world / 0.1 - 1.0).abs() < 0.15, "{eye_depth}: {world}");
    }
    // Nearer than its bound it is that many pixels, and far away it ends.
    let near = deviation(&settings, 0.5);
    assert!((near / 10.0 - 1.0).abs() < 0.02, "{near}");
    assert!(deviation(&settings, 1000.0) < 1e-3);
}

/// Bells add up.
#[test]
fn iterations_widen_as_their_root() {
    let once = EyeBlur { radius: 0.05, ..EyeBlur::default() };
    let single = deviation(&once, 4.0);
    for iterations in [2, 4, 9, 16] {
        let wide = deviation(&EyeBlur { iterations, ..once }, 4.0);
        let expected = single * f64::from(iterations).sqrt();
        assert!((wide / expected - 1.0).abs() < 0.02, "{iterations}: {wide} and {expected}");
    }
}

/// Every depth convention, and where nothing is.
#[test]
fn depths_of_all_conventions() {
    let (near, far) = (0.5, 80.0);
    let perspective = |z: f64, w: f64| {
        DMat4::from_cols(DVec4::X * 2.0, DVec4::Y * 2.0, DVec4::new(0.0, 0.0, z, -1.0), DVec4::new(0.0, 0.0, w, 0.0))
    };
    let standard = perspective(far / (near - far), near * far / (near - far));
    let backwards = perspective(near / (far - near), near * far / (far - near));
    let endless = perspective(0.0, near);
    let mut flat = DMat4::from_diagonal(DVec4::new(0.1, 0.1, 1.0 / (near - far), 1.0));
    flat.w_axis.z = near / (near - far);
    let settings = EyeBlur { radius: 0.5, most: 32.0, ..EyeBlur::default() };
    for (matrix, is_flat) in [(standard, false), (backwards, false), (endless, false), (flat, true)] {
        let uniforms = settings.uniforms(&matrix, SIZE).unwrap();
        for eye in [0.5, 1.0, 7.0, 80.0] {
            let clip = matrix * DVec4::new(0.0, 0.0, -eye, 1.0);
            let found = f64::from(antumbra_eye_depth(&uniforms, (clip.z / clip.w) as f32));
            assert!((found / eye - 1.0).abs() < 1e-3, "{found} instead of {eye}");
            let pixels = antumbra_eye_blur_deviation(&uniforms, eye as f32).as_dvec2();
            let expected = if is_flat { 0.1 } else { 2.0 / eye } * 0.5 * 0.5 * SIZE.as_dvec2();
            assert!((pixels - expected.min(glam::DVec2::splat(32.0))).length() < 1e-3 * pixels.length(), "{pixels}");
        }
    }
    let nowhere = antumbra_eye_depth(&settings.uniforms(&endless, SIZE).unwrap(), 0.0);
    assert!(nowhere >= 1e30 && nowhere.is_finite());
}

/// What a caller can get wrong is named.
#[test]
fn illegal_settings_are_named() {
    let legal = EyeBlur::default();
    for (settings, field) in [
        (EyeBlur { radius: -1.0, ..legal }, "blur.radius is -1; legal: 0 to 1e9"),
        (EyeBlur { most: 33.0, ..legal }, "blur.most is 33; legal: 0 to 32"),
        (EyeBlur { edge: f32::NAN, ..legal }, "blur.edge is NaN; legal: a finite number"),
        (EyeBlur { iterations: 0, ..legal }, "blur.iterations is 0; legal: 1 to 16"),
        (EyeBlur { iterations: 17, ..legal }, "blur.iterations is 17; legal: 1 to 16"),
    ] {
        assert_eq!(settings.uniforms(&camera(), SIZE).unwrap_err().to_string(), field);
    }
    // Neither infinity nor what f32 makes of it.
    for huge in [f64::INFINITY, 1e39] {
        assert!(legal.uniforms(&DMat4::from_diagonal(DVec4::splat(huge)), SIZE).is_err(), "{huge}");
    }
}
