use glam::dcamera::rh::proj::directx::{orthographic, perspective};
use glam::{DMat4, DVec2, DVec3, Mat4, Vec4};

use super::*;
use crate::lab::shapes::Random;
use crate::lab::treeline::treeline;

/// A model of loose triangles.
fn model(triangles: &[[DVec3; 3]]) -> SceneModel {
    SceneModel {
        positions: triangles.concat(),
        triangles: (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        objects: std::iter::once(0..triangles.len()).collect(),
        ..SceneModel::default()
    }
}

fn pass(clip_from_render: Mat4) -> RasterPass {
    RasterPass { clip_from_render, depth_from_render: None, origin: DVec3::ZERO }
}

fn drawn(model: &SceneModel, side: u32, pass: &RasterPass) -> DepthTarget {
    let mut target = DepthTarget::new(side, side, DepthMode::LessEqual);
    rasterise(&mut target, model, &model.objects, pass);
    target
}

/// Takes pixels (row 0 on top) and depths 0..1 for what they are.
fn screen(side: u32) -> Mat4 {
    orthographic(0.0, f64::from(side), f64::from(side), 0.0, 0.0, -1.0).as_mat4()
}

fn covered(target: &DepthTarget) -> Vec<usize> {
    (0..target.triangle.len()).filter(|&pixel| target.triangle[pixel] != NONE).collect()
}

/// Distance between two depths in units of the last place of 1.0.
fn ulps(a: f32, b: f64) -> f64 {
    (f64::from(a) - b).abs() / f64::from(f32::EPSILON)
}

#[test]
fn a_right_triangle_covers_the_pixels_the_top_left_rule_gives() {
    // Hypotenuse through the centres of pixels with x + y = 3: a right edge, so these stay out; top and left come in
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.5);
    for corners in [[(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)], [(0.0, 0.0), (0.0, 4.0), (4.0, 0.0)]] {
        let target = drawn(&model(&[corners.map(|(x, y)| corner(x, y))]), 4, &pass(screen(4)));
        assert_eq!(covered(&target), [0, 1, 2, 4, 5, 8], "corners {corners:?}");
        assert!(covered(&target).iter().all(|&pixel| target.depth[pixel] == 0.5));
    }

    // The other half owns its left edge: the hypotenuse
    let other = [(4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| corner(x, y));
    let target = drawn(&model(&[other]), 4, &pass(screen(4)));
    assert_eq!(covered(&target), [3, 6, 7, 9, 10, 11, 12, 13, 14, 15]);

    // A square from centre to centre owns its top and left side only
    let square = [(0.5, 0.5), (2.5, 0.5), (2.5, 2.5), (0.5, 2.5)].map(|(x, y)| corner(x, y));
    let halves = [[square[0], square[1], square[2]], [square[0], square[2], square[3]]];
    assert_eq!(covered(&drawn(&model(&halves), 4, &pass(screen(4)))), [0, 1, 4, 5]);
}

#[test]
fn triangles_around_a_point_cover_every_pixel_once() {
    const SIDE: u32 = 48;
    let mut random = Random::new(1);
    for case in 0..200 {
        // A fan about an inner point; sometimes on a pixel centre, sometimes reaching far beyond the screen
        let reach = if case % 3 == 0 { 30_000.0 } else { 0.0 };
        let (low, high) = (-reach, f64::from(SIDE) + reach);
        let inner = DVec2::new(random.range(1.0, 47.0), random.range(1.0, 47.0));
        let inner = if case % 2 == 0 { inner.floor() + 0.5 } else { inner };
        let rim = [(low, low), (20.0, low), (high, low), (high, 31.5), (high, high), (low, high), (low, 7.5)];
        let rim = rim.map(|(x, y)| DVec3::new(x, y, 0.25));
        let mut times = vec![0; (SIDE * SIDE) as usize];
        for i in 0..rim.len() {
            let one = model(&[[inner.extend(0.75), rim[i], rim[(i + 1) % rim.len()]]]);
            for pixel in covered(&drawn(&one, SIDE, &pass(screen(SIDE)))) {
                times[pixel] += 1;
            }
        }
        assert!(times.iter().all(|&times| times == 1), "case {case}, inner point {inner}");
    }
}

#[test]
fn depth_is_that_of_the_plane() {
    const SIDE: u32 = 64;
    let clip = perspective(1.0, 1.0, 0.5, 40.0);
    let inverse = clip.inverse();
    let mut random = Random::new(2);
    let (mut worst, mut pixels) = (0.0_f64, 0);
    for _ in 0..300 {
        let corners = [0; 3].map(|_| {
            let depth = random.range(-5.0, 38.0);
            DVec3::new(random.range(-0.6, 0.6) * depth, random.range(-0.6, 0.6) * depth, -depth)
        });
        let [a, b, c] = corners.map(|corner| corner.as_vec3().as_dvec3());
        let normal = (b - a).cross(c - a).normalize();
        let target = drawn(&model(&[corners]), SIDE, &pass(clip.as_mat4()));
        for pixel in covered(&target) {
            let x = ((pixel as u32 % SIDE) as f64 + 0.5) / 32.0 - 1.0;
            let y = 1.0 - ((pixel as u32 / SIDE) as f64 + 0.5) / 32.0;
            let ray = inverse.project_point3(DVec3::new(x, y, 0.5)).normalize();
            // Edge-on planes magnify the rounding of the matrix without bound: leave them to the range check
            if normal.dot(ray).abs() > 0.2 {
                let expected = clip.project_point3(ray * (normal.dot(a) / normal.dot(ray))).z;
                worst = worst.max(ulps(target.depth[pixel], expected));
                pixels += 1;
            }
        }
        assert!(target.depth.iter().all(|depth| (0.0..=1.0).contains(depth)));
    }
    assert!(pixels > 20_000, "only {pixels} pixels tested");
    assert!(worst <= 4.0, "{worst} units in the last place");
}

#[test]
fn a_floor_through_the_eye_is_clipped_at_the_near_plane() {
    // The floor reaches far behind the eye, 1 below it: it covers exactly what lies below the horizon within the planes
    const SIDE: u32 = 100;
    let floor = [(-500.0, 900.0), (500.0, 900.0), (500.0, -900.0), (-500.0, -900.0)];
    let [a, b, c, d] = floor.map(|(x, z)| DVec3::new(x, -1.0, z));
    let clip = perspective(std::f64::consts::FRAC_PI_2, 1.0, 2.0, 100.0);
    let target = drawn(&model(&[[a, b, c], [a, c, d]]), SIDE, &pass(clip.as_mat4()));
    for row in 0..SIDE as usize {
        // With tangents of 1, row centre y sees the floor at depth 1 / y
        let below = (row as f64 + 0.5) / 50.0 - 1.0;
        let seen = below > 0.0 && (2.0..100.0).contains(&(1.0 / below));
        let pixels = target.triangle[row * SIDE as usize..][..SIDE as usize].iter();
        assert!(pixels.clone().all(|&triangle| (triangle != NONE) == seen), "row {row}, expected {seen}");
    }
}

#[test]
fn nothing_behind_the_eye_and_nothing_at_it_is_drawn() {
    let clip = perspective(1.0, 1.0, 0.5, 40.0).as_mat4();
    let behind = [DVec3::new(-9.0, -9.0, 5.0), DVec3::new(9.0, -9.0, 5.0), DVec3::new(0.0, 9.0, 5.0)];
    let at_eye = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
    let point = [DVec3::new(0.0, 0.0, -2.0); 3];
    let target = drawn(&model(&[behind, at_eye, point]), 32, &pass(clip));
    assert_eq!(covered(&target), Vec::<usize>::new());
}

#[test]
fn huge_and_overflowing_coordinates_stay_harmless() {
    let clip = perspective(1.0, 1.0, 0.5, 40.0).as_mat4();
    let huge =
        |size: f64| [DVec3::new(-size, -size, -10.0), DVec3::new(size, -size, -10.0), DVec3::new(0.0, size, -10.0)];
    let mut target = DepthTarget::new(32, 32, DepthMode::LessEqual);
    let mut draw = |size: f64| {
        let model = model(&[huge(size)]);
        let count = rasterise(&mut target, &model, &model.objects, &pass(clip));
        (
            count.submitted,
            count.not_finite,
            covered(&target).len(),
            target.depth.iter().all(|d| (0.0..=1.0).contains(d)),
        )
    };
    assert_eq!(draw(1e300), (1, 1, 0, true));
    assert_eq!(draw(1e9), (1, 0, 32 * 32, true));
    // Where 1e30 cuts the screen is beyond what 53 bits can tell; it must be numbers all the same
    assert_eq!(draw(1e30), (1, 0, 32 * 32, true));
}

#[test]
fn the_nearer_depth_survives_and_of_equal_ones_the_later() {
    let at = |depth: f64| [(0.0, 0.0), (9.0, 0.0), (0.0, 9.0)].map(|(x, y)| DVec3::new(x, y, depth));
    let model = model(&[at(0.5), at(0.25), at(0.75), at(0.25), at(0.75)]);
    for (mode, winner, depth) in [(DepthMode::LessEqual, 3, 0.25), (DepthMode::GreaterEqual, 4, 0.75)] {
        let mut target = DepthTarget::new(2, 2, mode);
        rasterise(&mut target, &model, &[0..2, 2..5], &pass(screen(2)));
        assert_eq!(
            (target.triangle.as_slice(), target.depth.as_slice()),
            ([winner; 4].as_slice(), [depth; 4].as_slice())
        );
        target.clear();
        assert!(covered(&target).is_empty() && target.depth == [mode.cleared(); 4]);
    }
}

#[test]
fn cut_outs_have_holes_in_perspective() {
    // A floor card of one repeat, its mask solid where v < 1/2: the far half, which is the smaller part of the picture
    let corners = [(-4.0, -3.0), (4.0, -3.0), (4.0, -11.0), (-4.0, -11.0)].map(|(x, z)| DVec3::new(x, -1.0, z));
    let mut card = model(&[[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]);
    let uvs = [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(u, v)| DVec2::new(u, v));
    card.uvs = vec![uvs[0], uvs[1], uvs[2], uvs[0], uvs[2], uvs[3]];
    card.triangle_cutout = vec![0, 0];
    let mut alpha = vec![255; 64 * 32];
    alpha.extend([0; 64 * 32]);
    card.cutouts = vec![Cutout { width: 64, height: 64, alpha, cutoff: 0.5 }];

    let clip = perspective(1.0, 1.0, 0.5, 40.0);
    let target = drawn(&card, 256, &pass(clip.as_mat4()));
    let hits = resolve(&target, &card, &clip.inverse(), DVec3::ZERO);
    let depths: Vec<f64> = hits.iter().flatten().map(|hit| -hit.position.z).collect();
    let (least, most) = depths.iter().fold((f64::MAX, 0.0_f64), |(low, high), &z| (low.min(z), high.max(z)));
    // v = 1/2 lies at depth 7, where a row is 0.2 m; the repeat filters the last texel row (1/8 m deep) into the far
    // end
    assert!((7.0..7.25).contains(&least) && (10.7..11.0).contains(&most), "solid from {least} to {most}");

    // Without the mask the near half shows too
    card.triangle_cutout = vec![crate::lab::scene::SOLID; 2];
    assert!(covered(&drawn(&card, 256, &pass(clip.as_mat4()))).len() > depths.len() * 2);
}

#[test]
fn a_depth_row_is_stored_perspective_correctly() {
    // Store eye depth / 40, which is not linear on the screen
    let floor = [DVec3::new(-90.0, -1.0, -1.0), DVec3::new(90.0, -1.0, -1.0), DVec3::new(0.0, -1.0, -39.0)];
    let floor = model(&[floor]);
    let clip = perspective(1.0, 1.0, 0.5, 40.0);
    let row = Some(Vec4::new(0.0, 0.0, -1.0 / 40.0, 0.0));
    let target = drawn(&floor, 64, &RasterPass { depth_from_render: row, ..pass(clip.as_mat4()) });
    let hits = resolve(&target, &floor, &clip.inverse(), DVec3::ZERO);
    assert!(hits.iter().flatten().count() > 1000);
    for (hit, depth) in hits.iter().zip(&target.depth).filter_map(|(hit, depth)| hit.map(|hit| (hit, depth))) {
        assert!((f64::from(*depth) + hit.position.z / 40.0).abs() < 2e-6, "{depth} at {}", hit.position);
    }
}

#[test]
fn hits_project_back_to_their_pixels_and_face_the_viewer() {
    const SIDE: u32 = 96;
    let scene = treeline();
    let origin = DVec3::new(-2.0, 1.7, 3.6);
    let turn = DMat4::from_rotation_y(0.4);
    let infinite = glam::dcamera::rh::proj::directx::perspective_infinite_reverse(0.8, 1.0, 0.5);
    let cases = [
        ("perspective", perspective(0.8, 1.0, 0.5, 50.0), DepthMode::LessEqual),
        ("reversed, infinite", infinite, DepthMode::GreaterEqual),
        ("orthographic", orthographic(-4.0, 4.0, -3.0, 5.0, 0.0, 60.0), DepthMode::LessEqual),
    ];
    for (name, projection, mode) in cases {
        let clip = projection * turn;
        let mut target = DepthTarget::new(SIDE, SIDE, mode);
        rasterise(&mut target, &scene, &scene.objects, &RasterPass { origin, ..pass(clip.as_mat4()) });
        let hits = resolve(&target, &scene, &clip.inverse(), origin);
        let (mut near, mut total) = (0, 0);
        for (pixel, hit) in hits.iter().enumerate().filter_map(|(pixel, hit)| hit.map(|hit| (pixel, hit))) {
            let back = clip.project_point3(hit.position);
            let x = (back.x + 1.0) * 48.0 - (pixel as u32 % SIDE) as f64 - 0.5;
            let y = (1.0 - back.y) * 48.0 - (pixel as u32 / SIDE) as f64 - 0.5;
            let depth = f64::from(target.depth[pixel]);
            total += 1;
            near += usize::from(x.abs() < 0.01 && y.abs() < 0.01 && (back.z - depth).abs() < 1e-4);

            // Towards the viewer is against the ray, which runs from the eye, or straight ahead
            let ray =
                if name == "orthographic" { turn.transpose().transform_vector3(DVec3::NEG_Z) } else { hit.position };
            assert!(hit.normal.is_normalized() && hit.normal.dot(ray) <= 1e-9, "{name}: pixel {pixel}");
        }
        assert!(total > 2000, "{name}: {total} hits");
        // Leaves seen edge-on may move by more than the snapping
        assert!(near * 1000 >= total * 999, "{name}: {near} of {total} return to their pixels");
    }
}

#[test]
fn equal_bits_whatever_the_number_of_threads() {
    let scene = treeline();
    let clip = perspective(0.8, 1.0, 1.0, 50.0) * DMat4::from_translation(DVec3::new(0.0, -2.0, -20.0));
    let images = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| drawn(&scene, 257, &pass(clip.as_mat4())))
    });
    assert_eq!(images[0].triangle, images[1].triangle);
    assert_eq!(images[0].depth, images[1].depth);
}

#[test]
#[should_panic(expected = "each side must be 1 to 16384")]
fn an_empty_target_is_refused() {
    let _ = DepthTarget::new(0, 4, DepthMode::LessEqual);
}
