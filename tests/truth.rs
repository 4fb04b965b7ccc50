//! The truth is held against what is known without it: published floors, exact shadows, all triangles tried one by one.

mod support;

use std::f64::consts::TAU;
use std::path::Path;

use antumbra::lab::bvh::{Bvh, Ray};
use antumbra::lab::case::{Case, CaseCamera, CaseLight, SceneSource};
use antumbra::lab::gltf;
use antumbra::lab::metrics::Scores;
use antumbra::lab::scene::{Cutout, SOLID, SceneModel};
use antumbra::lab::truth::{Truth, TruthCache};
use glam::{DVec2, DVec3};

/// Case, root mean square and mean absolute error of the perfect hard-edged mask against the area truth, from an
/// independent ray tracer.
const FLOORS: [(&str, f64, f64); 9] = [
    ("columns-row", 0.0526, 0.0073),
    ("fence-general", 0.0833, 0.0154),
    ("fence-stack", 0.0580, 0.0081),
    ("fence-wide", 0.0625, 0.0108),
    ("sparsecity-entity", 0.0273, 0.0021),
    ("sparsecity-overview", 0.0593, 0.0098),
    ("treeline-dueling", 0.0655, 0.0115),
    ("treeline-ground", 0.1107, 0.0273),
    ("treeline-trunk", 0.0961, 0.0236),
];

/// How far a floor may be off: both tracers sample.
const FLOOR_TOLERANCE: f64 = 0.02;

/// Half of the last digit of the published figures, which is as much as they say.
const FLOOR_ROUNDING: f64 = 0.000_05;

#[test]
fn floors_match_published_scores() {
    let Some(scenes) = support::scenes() else { return };
    println!("{:<20} {:>8} {:>8} {:>7} {:>8} {:>8} {:>7}", "case", "rmse", "known", "off", "mae", "known", "off");
    let mut misses = Vec::new();
    for (name, known_rmse, known_mae) in FLOORS {
        let (case, scene) = load(&scenes.join("../cases").join(format!("{name}.json")));
        let (truth, _) = TruthCache::default().get(&case, &scene, &|| ());
        let scores = Scores::new(&truth.centre, &truth).expect("the truth fits itself");
        let (rmse, mae) = (scores.floor_rmse, scores.floor_mae);
        let off = |found: f64, known: f64| 100.0 * (found / known - 1.0);
        let (rmse_off, mae_off) = (off(rmse, known_rmse), off(mae, known_mae));
        println!("{name:<20} {rmse:8.5} {known_rmse:8.4} {rmse_off:+6.1}% {mae:8.5} {known_mae:8.4} {mae_off:+6.1}%");
        for (found, known) in [(rmse, known_rmse), (mae, known_mae)] {
            let close = (found - known).abs() <= FLOOR_TOLERANCE * known + FLOOR_ROUNDING;
            if !close {
                misses.push(format!("{name}: {found:.5}, known {known}"));
            }
        }
        // The perfect mask is perfect against the centre truth.
        assert_eq!((scores.wrong_center, scores.edge_center_px), (0.0, Some(0.0)), "{name}");
    }
    assert!(misses.is_empty(), "floors off: {misses:?}");
}

fn load(path: &Path) -> (Case, SceneModel) {
    let case = Case::load(path).unwrap_or_else(|error| panic!("{error}"));
    match case.scene_source().unwrap_or_else(|error| panic!("{error}")) {
        SceneSource::File(file) => {
            let scene = gltf::load(&file).unwrap_or_else(|error| panic!("{error}"));
            (case, scene)
        }
        SceneSource::BuiltIn(name) => panic!("{} asks for the built-in {name}", path.display()),
    }
}

/// A camera and a directional light over geometry made here.
fn case_over(eye: DVec3, target: DVec3, up: DVec3, travel: DVec3, viewport: [u32; 2]) -> Case {
    let camera = CaseCamera { eye, target, up, fov_y_deg: 40.0, near: 0.1, far: 100.0 };
    support::case_over(camera, travel, viewport)
}

/// A point of the plane y = 0 seen at a place of the picture, in pixels from its upper left corner.
fn ground_at(case: &Case, x: f64, y: f64) -> DVec3 {
    let [left, right, lower, upper] = case.tangents();
    let [width, height] = case.viewport.map(f64::from);
    let view = DVec3::new(left + (right - left) * x / width, upper + (lower - upper) * y / height, -1.0);
    let direction = case.world_from_view().transform_vector3(view);
    case.camera.eye - direction * (case.camera.eye.y / direction.y)
}

const GROUND_HALF_SIDE: f64 = 50.0;

/// Two triangles in the plane y = 0; the first two of every scene made here.
fn ground() -> SceneModel {
    let corner = |x: f64, z: f64| DVec3::new(x * GROUND_HALF_SIDE, 0.0, z * GROUND_HALF_SIDE);
    SceneModel {
        positions: vec![corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..SceneModel::default()
    }
}

/// Adds a grid of quads: `point(i, j)` for i in 0..=columns, j in 0..=rows.
fn add_grid(scene: &mut SceneModel, columns: u32, rows: u32, point: impl Fn(u32, u32) -> DVec3) {
    let base = scene.positions.len() as u32;
    for j in 0..=rows {
        scene.positions.extend((0..=columns).map(|i| point(i, j)));
    }
    let index = |i: u32, j: u32| base + j * (columns + 1) + i;
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
        scene.triangles.extend([[a, b, c], [a, c, d]]);
    }
}

/// Adds a closed sphere; seam and poles are the same points to the last bit.
fn add_sphere(scene: &mut SceneModel, centre: DVec3, radius: f64, segments: u32) {
    let step = TAU / f64::from(segments);
    add_grid(scene, segments, segments / 2, |i, j| {
        let (sin_i, cos_i) = (f64::from(i % segments) * step).sin_cos();
        let (sin_j, cos_j) = if j % (segments / 2) == 0 {
            (0.0, 1.0 - 4.0 * f64::from(j) / f64::from(segments))
        } else {
            (f64::from(j) * step).sin_cos()
        };
        centre + radius * DVec3::new(sin_j * cos_i, cos_j, sin_j * sin_i)
    });
}

/// The shadow of a sphere on a plane is an ellipse: a point is in it when the light's line through it passes the centre
/// closer than the radius. The area truth must put the boundary there.
#[test]
fn a_spheres_shadow_is_an_ellipse_to_a_tenth_of_a_pixel() {
    const MAX_ERROR_PX: f64 = 0.1;
    // Where the boundary is shorter than this it cuts a corner off: there the area is what counts.
    const CORNER_LENGTH_PX: f64 = 0.5;
    const MAX_CORNER_AREA: f64 = 1.0 / 16.0;
    // Segments of the sphere: its silhouette is then 2e-5 radii inside the true one, below 0.001 px.
    const SEGMENTS: u32 = 512;
    let (centre, radius) = (DVec3::new(0.3, 2.0, -0.2), 1.0);
    let travel = DVec3::new(0.6, -1.0, 0.35).normalize();
    let mut scene = ground();
    add_sphere(&mut scene, centre, radius, SEGMENTS);
    let case = case_over(DVec3::new(2.0, 6.0, 7.0), DVec3::new(1.0, 0.5, 0.2), DVec3::Y, travel, [320, 240]);
    let truth = Truth::trace(&case, &scene, &|| ());
    let ellipse = |x: f64, y: f64| (ground_at(&case, x, y) - centre).cross(travel).length() - radius;

    // In each pixel of open ground that the boundary cuts, move the exact boundary until it covers what the truth
    // says: the difference of the areas, by the boundary's length in the pixel.
    let (width, height) = (truth.width as usize, truth.height as usize);
    let is_ground = |x: usize, y: usize| truth.triangle[y * width + x] < 2;
    let is_open = |x: usize, y: usize| (0..9).all(|k| is_ground(x + k % 3 - 1, y + k / 3 - 1));
    let mut errors = Vec::new();
    for (y, x) in (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| (y, x))).filter(|&(y, x)| is_open(x, y)) {
        let (left, top) = (x as f64, y as f64);
        let slope_x = ellipse(left + 1.0, top + 0.5) - ellipse(left, top + 0.5);
        let slope_y = ellipse(left + 0.5, top + 1.0) - ellipse(left + 0.5, top);
        let per_pixel = slope_x.hypot(slope_y);
        let exact = |shift: f64| pixel_area(left, top, |x, y| ellipse(x, y) + shift * per_pixel);
        let area = exact(0.0);
        let error = (f64::from(truth.area[y * width + x]) - area).abs();
        let step = 0.01;
        let length = (exact(step) - exact(-step)) / (2.0 * step);
        if length >= CORNER_LENGTH_PX {
            errors.push(error / length);
        } else {
            assert!(error < if length > 0.0 { MAX_CORNER_AREA } else { 1e-6 }, "pixel {x}, {y}: {error}");
        }
    }
    let (worst, mean) = (errors.iter().copied().fold(0.0, f64::max), errors.iter().sum::<f64>() / errors.len() as f64);
    println!("ellipse: {} places, mean error {mean:.4} px, greatest {worst:.4} px", errors.len());
    assert!(errors.len() > 200);
    assert!(worst <= MAX_ERROR_PX, "{worst} px");
}

/// Area of the part of a pixel where a function is positive, by parts small enough to be flat.
fn pixel_area(left: f64, top: f64, function: impl Fn(f64, f64) -> f64) -> f64 {
    const PARTS: u32 = 4;
    let size = 1.0 / f64::from(PARTS);
    let parts = (0..PARTS * PARTS).map(|part| {
        let (x, y) = (left + f64::from(part % PARTS) * size, top + f64::from(part / PARTS) * size);
        let corners = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)];
        positive_area(&corners.map(|(x, y)| (DVec2::new(x - left, y - top), function(x, y))))
    });
    parts.sum()
}

/// Seen straight from above, the shadow of a wall's straight edge is a half-plane,
/// and each pixel's share of it is known.
#[test]
fn a_walls_shadow_covers_what_geometry_says() {
    let along = DVec3::new(1.0, 0.0, 0.3).normalize();
    let foot = DVec3::new(0.0, 0.0, -1.0);
    let mut scene = ground();
    add_grid(&mut scene, 1, 1, |i, j| foot + along * (60.0 * f64::from(i) - 30.0) + DVec3::Y * 2.0 * f64::from(j));
    let travel = DVec3::new(0.1, -1.0, 0.7);
    let (eye, target) = (DVec3::new(0.2, 12.0, 0.9), DVec3::new(0.2, 0.0, 0.9));
    let case = case_over(eye, target, DVec3::NEG_Z, travel, [97, 61]);
    let truth = Truth::trace(&case, &scene, &|| ());
    // The upper edge lands where the light takes it from its height; there is light beyond.
    let landing = foot + travel * 2.0;
    let beyond = DVec3::new(-along.z, 0.0, along.x);
    let past = |point: DVec3, x: f64, y: f64| (ground_at(&case, x, y) - point).dot(beyond);

    let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for (index, area) in truth.area.iter().enumerate() {
        let (x, y) = ((index % 97) as f64, (index / 97) as f64);
        let corners = [(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)];
        // Leave out the wall itself, the ground before it, and what perspective shows of its side.
        if truth.triangle[index] >= 2 || corners.iter().any(|&(x, y)| past(foot, x, y) < 0.3) {
            continue;
        }
        assert_eq!(truth.centre[index] == 1.0, past(landing, x + 0.5, y + 0.5) > 0.0, "pixel {x}, {y}");
        let exact = pixel_area(x, y, |x, y| past(landing, x, y));
        let error = (f64::from(*area) - exact).abs();
        if exact > 0.0 && exact < 1.0 {
            (worst, sum, count) = (worst.max(error), sum + error, count + 1);
        } else {
            assert!(error < 1e-9, "pixel {x}, {y}: {area}, exactly {exact}");
        }
    }
    let mean = sum / f64::from(count);
    println!("half-plane: {count} cut pixels, mean error {mean:.4}, greatest {worst:.4}");
    assert!(count > 90 && mean < 0.02 && worst < 0.08, "{count} pixels, mean {mean}, worst {worst}");
}

/// Area of the part of a polygon where a function that is linear over it is positive.
fn positive_area(polygon: &[(DVec2, f64)]) -> f64 {
    let mut kept: Vec<DVec2> = Vec::new();
    for (i, &(a, value_a)) in polygon.iter().enumerate() {
        let (b, value_b) = polygon[(i + 1) % polygon.len()];
        if value_a > 0.0 {
            kept.push(a);
        }
        if (value_a > 0.0) != (value_b > 0.0) {
            kept.push(a.lerp(b, value_a / (value_a - value_b)));
        }
    }
    let doubled: f64 = (0..kept.len()).map(|i| kept[i].perp_dot(kept[(i + 1) % kept.len()])).sum();
    (doubled * 0.5).abs()
}

/// Numbers in -1..1, the same on every run (xorshift).
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

fn random_point(state: &mut u64) -> DVec3 {
    DVec3::new(random(state), random(state), random(state))
}

/// A torus as large as a teapot, and loose triangles through it, every third with a checkered mask.
fn clutter(scale: f64, offset: DVec3) -> SceneModel {
    let mut scene = SceneModel::default();
    add_grid(&mut scene, 64, 25, |i, j| {
        let (sin_i, cos_i) = (f64::from(i) / 64.0 * TAU).sin_cos();
        let (sin_j, cos_j) = (f64::from(j) / 25.0 * TAU).sin_cos();
        DVec3::new((0.6 + 0.25 * cos_j) * cos_i, 0.25 * sin_j, (0.6 + 0.25 * cos_j) * sin_i)
    });
    let mut state = 7;
    for _ in 0..500 {
        let (base, centre) = (scene.positions.len() as u32, random_point(&mut state));
        scene.positions.extend((0..3).map(|_| centre + random_point(&mut state) * 0.1));
        scene.triangles.push([base, base + 1, base + 2]);
    }
    scene.uvs = (0..scene.positions.len()).map(|i| DVec2::new((i % 3) as f64, (i / 3 % 4) as f64 * 0.7)).collect();
    scene.triangle_cutout = (0..scene.triangles.len()).map(|i| if i % 3 == 0 { 0 } else { SOLID }).collect();
    scene.cutouts = vec![Cutout { width: 2, height: 2, alpha: vec![0, 255, 255, 0], cutoff: 0.5 }];
    scene.positions.iter_mut().for_each(|position| *position = *position * scale + offset);
    scene
}

/// Tries every triangle in turn, by the formula of Möller and Trumbore in f64; `skip` is left out.
fn brute_force(scene: &SceneModel, ray: &Ray, skip: Option<u32>) -> Option<(f64, u32)> {
    let hits = (0..scene.triangles.len()).filter_map(|triangle| {
        let [a, b, c] = scene.corners(triangle);
        let (e1, e2, s) = (b - a, c - a, ray.origin - a);
        let p = ray.direction.cross(e2);
        let q = s.cross(e1);
        let scale = 1.0 / e1.dot(p);
        let (u, v, t) = (s.dot(p) * scale, ray.direction.dot(q) * scale, e2.dot(q) * scale);
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > ray.t_min && t < ray.t_max;
        let solid = inside && scene.is_solid(triangle, DVec3::new(1.0 - u - v, u, v));
        (solid && skip != Some(triangle as u32)).then_some((t, triangle as u32))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
}

#[test]
fn the_hierarchy_finds_what_trying_all_triangles_finds() {
    const RAYS: usize = 4000;
    // A teapot, a grain of dust, a landscape, and a house far from the origin.
    for (scale, offset) in [(1.0, 0.0), (1e-4, 0.0), (3e4, 0.0), (10.0, 1e6)] {
        let offset = DVec3::splat(offset);
        let scene = clutter(scale, offset);
        let bvh = Bvh::new(&scene);
        let mut state = 42;
        let mut hit_count = 0;
        for number in 0..RAYS {
            // Start inside, outside, or far outside; aim at the middle; sometimes along an axis.
            let reach = [1.0, 3.0, 1000.0][number % 3];
            let origin = random_point(&mut state) * reach;
            let mut direction = (random_point(&mut state) - origin).normalize() * (2.0 + random(&mut state));
            if number % 10 == 0 {
                let axis = number / 10 % 3;
                direction = DVec3::AXES[axis] * -origin[axis].signum();
            }
            let t_max = if number % 2 == 0 { f64::INFINITY } else { reach };
            let ray = Ray { origin: origin * scale + offset, direction: direction * scale, t_min: 0.0, t_max };
            let (expected, found) = (brute_force(&scene, &ray, None), bvh.closest(&ray));
            let tolerance = 1e-11 * reach.max(offset.length() / scale);
            assert_eq!(bvh.is_blocked(&ray, None), expected.is_some(), "scale {scale}, ray {number}");
            match (expected, found) {
                (None, None) => {}
                (Some((t, triangle)), Some(hit)) if (t - hit.t).abs() <= tolerance => {
                    hit_count += 1;
                    // Without the first triangle, the rest of the ray decides.
                    let behind = brute_force(&scene, &ray, Some(triangle)).is_some();
                    assert_eq!(bvh.is_blocked(&ray, Some(triangle)), behind, "scale {scale}, ray {number}");
                }
                _ => panic!("scale {scale}, ray {number}: {ray:?}: expected {expected:?}, found {found:?}"),
            }
        }
        assert!(hit_count > RAYS / 5, "only {hit_count} rays hit at scale {scale}");
    }
}

#[test]
fn no_ray_slips_between_triangles() {
    let mut scene = SceneModel::default();
    let centre = DVec3::new(0.1, -0.7, 0.3);
    add_sphere(&mut scene, centre, 1.0, 48);
    let bvh = Bvh::new(&scene);
    for triangle in 0..scene.triangles.len() {
        let [a, b, c] = scene.corners(triangle);
        // From inside, every corner and every middle of an edge must stop the ray.
        for target in [a, b, c, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5] {
            for origin in [centre, DVec3::new(0.2, -0.5, 0.1)] {
                let ray = Ray { origin, direction: target - origin, t_min: 0.0, t_max: f64::INFINITY };
                let hit = bvh.closest(&ray).unwrap_or_else(|| panic!("slipped past triangle {triangle} at {target}"));
                assert!((hit.t - 1.0).abs() < 1e-9);
                assert!(bvh.is_blocked(&ray, None));
            }
        }
    }
}

#[test]
fn scenes_of_no_or_one_triangle_and_degenerate_rays_are_handled() {
    let empty = SceneModel::default();
    let down = Ray { origin: DVec3::Y, direction: DVec3::NEG_Y, t_min: 0.0, t_max: f64::INFINITY };
    assert_eq!(Bvh::new(&empty).closest(&down), None);
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Z, DVec3::X * 2.0];
    let one = SceneModel { positions, triangles: vec![[0, 1, 2]], ..SceneModel::default() };
    let bvh = Bvh::new(&one);
    let hit = bvh.closest(&Ray { origin: DVec3::new(0.2, 1.0, 0.2), ..down }).expect("the ray meets the triangle");
    assert!(hit.triangle == 0 && (hit.t - 1.0).abs() < 1e-15);
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        assert_eq!(bvh.closest(&Ray { direction, ..down }), None);
    }
    assert_eq!(bvh.closest(&Ray { origin: DVec3::NAN, ..down }), None);
    assert_eq!(bvh.closest(&Ray { t_max: f64::NAN, ..down }), None);
    // A triangle without area is never hit.
    let flat = SceneModel { triangles: vec![[0, 1, 3]], ..one.clone() };
    assert_eq!(Bvh::new(&flat).closest(&Ray { origin: DVec3::new(0.5, 1.0, 0.0), ..down }), None);
}

/// Surfaces that coincide must not shadow each other, at any angle of the light.
#[test]
fn coincident_and_grazing_surfaces_stay_lit() {
    let mut scene = ground();
    for _ in 0..4 {
        scene.triangles.extend([[0, 1, 2], [0, 2, 3]]);
    }
    // The same square again, cut along the other diagonal.
    scene.triangles.extend([[1, 2, 3], [1, 3, 0]]);
    for elevation in [1.0, 1e-2, 1e-4] {
        let travel = DVec3::new(1.0, -elevation, 0.3);
        let case = case_over(DVec3::new(0.0, 3.0, 9.0), DVec3::ZERO, DVec3::Y, travel, [64, 48]);
        let truth = Truth::trace(&case, &scene, &|| ());
        assert!(truth.valid_count() > 1000);
        let dark = (0..truth.area.len()).filter(|&i| truth.valid[i] && truth.area[i] < 1.0).count();
        assert_eq!(dark, 0, "of {} pixels at elevation {elevation}", truth.valid_count());
    }
}

/// Spot and point lights: what they cannot reach is not judged, the rest is lit or in shadow.
#[test]
fn local_lights_end_at_cone_and_range() {
    let mut scene = ground();
    // A square of side 1 at height 1, below a light at height 2: its shadow has side 2.
    add_grid(&mut scene, 1, 1, |i, j| DVec3::new(f64::from(i) - 0.5, 1.0, f64::from(j) - 0.5));
    let mut case = case_over(DVec3::new(0.0, 12.0, 3.0), DVec3::ZERO, DVec3::Y, DVec3::NEG_Y, [160, 120]);
    let position = DVec3::new(0.0, 2.0, 0.0);
    let lights = [
        CaseLight::Point { position, range: 2.5 },
        CaseLight::Spot { position, travel: DVec3::NEG_Y, half_angle_deg: 50.0, range: 100.0 },
    ];
    // Radii on the ground: the range's and the cone's.
    for (light, radius) in lights.into_iter().zip([1.5, 2.0 * 50.0_f64.to_radians().tan()]) {
        case.light = light;
        let truth = Truth::trace(&case, &scene, &|| ());
        let mut seen = [0; 3];
        for index in (0..truth.valid.len()).filter(|&index| truth.triangle[index] < 2) {
            let point = ground_at(&case, (index % 160) as f64 + 0.5, (index / 160) as f64 + 0.5);
            let (inside, shadowed) = (point.length() < radius, point.x.abs().max(point.z.abs()) < 1.0);
            assert_eq!(truth.valid[index], inside, "at {point}");
            if inside {
                assert_eq!(truth.centre[index], f32::from(u8::from(!shadowed)), "at {point}");
            }
            seen[usize::from(inside) + usize::from(inside && shadowed)] += 1;
        }
        assert!(seen.iter().all(|&count| count > 10), "every kind of pixel occurs: {seen:?}");
    }
}

#[test]
fn equal_inputs_give_equal_bits_on_any_number_of_threads() {
    let scene = clutter(1.0, DVec3::ZERO);
    let case = case_over(DVec3::new(0.5, 1.5, 2.5), DVec3::ZERO, DVec3::Y, DVec3::new(0.3, -1.0, 0.2), [48, 36]);
    let traced = Truth::trace(&case, &scene, &|| ());
    let single = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    assert_eq!(single.install(|| Truth::trace(&case, &scene, &|| ())), traced);
    assert!(traced.valid_count() > 200);
}
