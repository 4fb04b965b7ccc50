//! Penumbras against ray-traced truth: that truth is held against a penumbra that is known, and soft shadows against
//! it, beside the hard ones of the same map. On a row of columns, and on the shared case of one (where `ANTUMBRA_SCENES`
//! names the folder of scenes beside the cases).

mod support;

use std::f64::consts::PI;

use antumbra::lab::case::{Case, CaseCamera};
use antumbra::lab::comparison::Assignment;
use antumbra::lab::experiment::{Backend, Shot, Studio};
use antumbra::lab::metrics::{Edges, Scores, mask_from_bytes, near_edges};
use antumbra::lab::scene::SceneModel;
use antumbra::lab::shapes::MeshBuilder;
use antumbra::lab::subject::{Setting, Subject};
use antumbra::lab::truth::{Truth, TruthCache};
use antumbra::{Encoding, Pcf, Remix, SUN_ANGLE, techniques};
use glam::DVec3;

/// Pixels of the pictures: a soft truth is at least ten times as many rays as a hard one.
const PICTURE: [u32; 2] = [400, 300];

/// Half the side of the ground, world units.
const GROUND: f64 = 60.0;

fn case_over(eye: DVec3, target: DVec3, up: DVec3, travel: DVec3, viewport: [u32; 2]) -> Case {
    let camera = CaseCamera { eye, target, up, fov_y_deg: 45.0, near: 0.1, far: 200.0 };
    support::case_over(camera, travel, viewport)
}

fn ground(builder: &mut MeshBuilder) {
    let corner = |x: f64, z: f64| DVec3::new(x * GROUND, 0.0, z * GROUND);
    builder.polygon(&[corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)]);
    builder.end_object();
}

/// Columns of four heights in a row, so far apart, on open ground.
fn columns(spacing: f64) -> SceneModel {
    let mut builder = MeshBuilder::new("columns");
    ground(&mut builder);
    for column in -5..=5_i32 {
        let x = spacing * f64::from(column);
        let height = 4.0 + 5.0 * f64::from(column.rem_euclid(4));
        builder.aligned_box(DVec3::new(x - 0.6, 0.0, -0.6), DVec3::new(x + 0.6, height, 0.6));
        builder.end_object();
    }
    builder.finish()
}

/// The share of a disc of radius 1 that lies above a line at a height.
fn above(height: f64) -> f64 {
    let x = height.clamp(-1.0, 1.0);
    0.5 - (x * (1.0 - x * x).sqrt() + x.asin()) / PI
}

/// Behind a long wall the share of the light's disc above its edge is known, at every point of the ground.
#[test]
fn a_walls_penumbra_is_what_geometry_says() {
    const HEIGHT: f64 = 8.0;
    let mut builder = MeshBuilder::new("wall");
    ground(&mut builder);
    let corner = |x: f64, y: f64| DVec3::new(x * GROUND, y * HEIGHT, 0.0);
    builder.polygon(&[corner(-1.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
    builder.end_object();
    let scene = builder.finish();
    let travel = DVec3::new(0.2, -1.0, -0.8).normalize();
    let (eye, target) = (DVec3::new(0.0, 6.0, -6.4), DVec3::new(0.0, 0.0, -6.4));
    let case = case_over(eye, target, DVec3::NEG_Z, travel, [96, 72]);
    for angle in [0.02, 0.1, 0.4] {
        let truth = Truth::soft(&case, &scene, angle, &|| ());
        let (left, upper) = (case.tangents()[0], case.tangents()[3]);
        let (mut worst, mut sum, mut penumbra) = ([0.0_f64; 2], [0.0; 2], 0);
        for pixel in 0..truth.centre.len() {
            // The camera looks straight down, its right is x and its down is +z.
            let place = [pixel % 96, pixel / 96].map(|index| index as f64 + 0.5);
            let at = |[x, y]: [f64; 2]| {
                eye + eye.y * DVec3::new(left * (1.0 - 2.0 * x / 96.0), -1.0, -upper * (1.0 - 2.0 * y / 72.0))
            };
            // The plane through the point and the wall's edge, and how it cuts the disc.
            let lit = |at: DVec3| {
                let normal = (DVec3::Y * HEIGHT - at).cross(DVec3::X).normalize();
                let across = normal + travel * normal.dot(-travel);
                above(normal.dot(travel) / ((0.5 * angle).tan() * across.length()))
            };
            let exact = lit(at(place));
            let mean = (0..64).map(|part| {
                let part = [part % 8, part / 8].map(|step| (f64::from(step) + 0.5) / 8.0 - 0.5);
                lit(at([place[0] + part[0], place[1] + part[1]]))
            });
            let off = |found: f32, known: f64| (f64::from(found) - known).abs();
            let errors = [off(truth.centre[pixel], exact), off(truth.area[pixel], mean.sum::<f64>() / 64.0)];
            for (kind, error) in errors.into_iter().enumerate() {
                worst[kind] = worst[kind].max(error);
                sum[kind] += error;
            }
            penumbra += usize::from(exact > 0.0 && exact < 1.0);
        }
        let mean = sum.map(|sum| sum / f64::from(penumbra as u32));
        println!("{angle} rad: {penumbra} pixels of penumbra, error {mean:.4?}, at most {worst:.4?} (centre, area)");
        assert!(penumbra > 200);
        assert!(mean[0] < 0.015 && mean[1] < 0.006, "{angle}: {mean:?}");
        assert!(worst[0] < 0.05 && worst[1] < 0.025, "{angle}: {worst:?}");
    }
}

/// What a mask is beside a soft truth.
#[derive(Debug)]
struct Against {
    rmse: f64,
    mae: f64,
    /// Shares of the valid pixels that are darker and lighter than the truth by more than ¼, more than 2 pixels from
    /// any penumbra.
    darker: f64,
    lighter: f64,
}

impl Against {
    fn new(shot: &Shot, truth: &Truth) -> Self {
        let mask = mask_from_bytes(&shot.mask);
        let Scores { rmse, mae, .. } = Scores::new(&mask, truth).expect("a mask of the right size");
        let near = near_edges(truth, Edges::Area);
        let share = |sign: f32| {
            let off = |pixel: &usize| {
                truth.valid[*pixel] && !near[*pixel] && sign * (mask[*pixel] - truth.area[*pixel]) > 0.25
            };
            (0..mask.len()).filter(off).count() as f64 / truth.valid_count() as f64
        };
        Self { rmse, mae, darker: share(-1.0), lighter: share(1.0) }
    }
}

/// The masks of one focused map, read softly, by its nearest texel, by four and by sixteen, against its truth.
fn measure(case: &Case, subject: &Subject, side: u32, angle: f32) -> [Against; 4] {
    let (truth, _) = TruthCache::default().soft(case, &subject.model, f64::from(angle), &|| ());
    let mut backend = Backend::Cpu;
    let mut studio = Studio::new(&mut backend, subject, Setting::of(case)).expect("a scene that fits");
    let hard = [Pcf::Point, Pcf::Hardware2x2, Pcf::Box3x3].map(Encoding::Depth);
    [Encoding::Soft { angle }, hard[0], hard[1], hard[2]].map(|encoding| {
        let shot = studio.shoot(&Remix { encoding, ..techniques::fsm() }, side, 1).expect("a picture");
        let against = Against::new(&shot, &truth);
        println!("{}, {side} texels, {angle} rad, {encoding:?}: {against:.5?}", case.name);
        against
    })
}

/// Most pixels that are darker than the truth by a quarter away from penumbras, and lighter, share of the valid ones:
/// what is asked of acne.
const MOST_OFF: f64 = 2e-4;

/// Half of the last digit of what the manual says, and a little more for other processors.
const WITHIN: f64 = 0.006;

/// Soft shadows are nearer to the truth of a light with a size than hard ones of the same map are, and no darker away
/// from penumbras.
#[test]
fn soft_shadows_are_nearer_to_the_truth_than_hard_ones() {
    let subject = Subject::new(columns(6.0));
    let (eye, target) = (DVec3::new(24.0, 9.0, 16.0), DVec3::new(0.0, 2.0, -6.0));
    let case = case_over(eye, target, DVec3::Y, DVec3::new(0.3, -0.75, -0.55), PICTURE);
    // With what the manual says of mean absolute errors, soft over bilinear.
    for (side, angle, quoted) in
        [(1024, SUN_ANGLE, 0.92), (2048, SUN_ANGLE, 0.86), (1024, 0.04, 0.49), (2048, 0.04, 0.44)]
    {
        let [soft, point, linear, _] = measure(&case, &subject, side, angle);
        support::as_quoted(&format!("{side}, {angle}"), soft.mae / linear.mae, quoted, WITHIN);
        for hard in [point, linear] {
            assert!(soft.mae < hard.mae && soft.rmse < hard.rmse, "{side}, {angle}: {soft:?}, hard {hard:?}");
        }
        assert!(soft.darker < MOST_OFF && soft.lighter < MOST_OFF, "{side}, {angle}: {soft:?}");
    }
}

/// Faces that graze the light stay lit where the map is coarse: a lookup moves no farther along their normal than its
/// disc is wide. (As far as the widest disc is, it was in the shadow of the next column: 3.9 % of the pixels of the row
/// below were dark, away from any penumbra.)
#[test]
fn grazing_faces_stay_lit() {
    let subject = Subject::new(columns(3.0));
    let (eye, target) = (DVec3::new(-24.0, 9.0, 16.0), DVec3::new(0.0, 4.0, -2.0));
    let case = case_over(eye, target, DVec3::Y, DVec3::new(0.12, -0.6, -0.55), PICTURE);
    for side in [512, 1024] {
        // Of filters that are always as wide, this is the narrowest that is wider than a narrow disc.
        let [soft, _, _, wide] = measure(&case, &subject, side, SUN_ANGLE);
        assert!(soft.darker <= wide.darker + MOST_OFF, "{side}: {soft:?}, hard {wide:?}");
    }
}

/// The same on the shared case of a row of columns, as far as it can show a sun's penumbras: they are narrower than a
/// texel but for the largest map.
#[test]
fn soft_shadows_are_as_near_to_the_truth_on_the_row_of_columns() {
    let Some(scenes) = support::scenes() else { return };
    let assignment = Assignment::of_case(&scenes.join("../cases/columns-row.json")).expect("a legal case");
    let case = Case { viewport: PICTURE, ..assignment.cases[0].clone() };
    for (side, quoted) in [(1024, 0.995), (2048, 0.988), (4096, 0.939)] {
        let [soft, point, linear, _] = measure(&case, &assignment.subject, side, SUN_ANGLE);
        support::as_quoted(&format!("{side}, mean absolute"), soft.mae / linear.mae, quoted, 0.5 * WITHIN);
        if side == 1024 {
            support::as_quoted("1024, root mean square", soft.rmse / linear.rmse, 1.02, WITHIN);
            continue;
        }
        assert!(soft.mae < point.mae && soft.mae < linear.mae, "{side}: {soft:?}, hard {point:?}, {linear:?}");
        assert!(soft.darker < MOST_OFF && soft.lighter < MOST_OFF, "{side}: {soft:?}");
    }
}
