//! What the rule for grazing light does to pictures: walls nearly parallel to the light, and a built-in viewpoint.
//!
//! A half is never wrong by more than a half, so that figures that count such pixels praise the rule wherever it
//! holds; the mean error shows what it costs.

mod support;

use antumbra::lab::cpu::{Visible, render};
use antumbra::lab::metrics::{Edges, Scores, mask_from_bytes, near_edges};
use antumbra::lab::shapes::MeshBuilder;
use antumbra::lab::sparse_city::sparse_city;
use antumbra::lab::statistics::mean;
use antumbra::lab::subject::{Setting, Subject, case_of};
use antumbra::lab::truth::Truth;
use antumbra::lab::viewpoints::{Viewpoint, sparse_city_viewpoints};
use antumbra::{Bias, Grazing, Light, Remix, ShadowTechnique, techniques};
use glam::{DMat3, DVec3};

/// Width and height of the pictures, pixels.
const PICTURE: [u32; 2] = [320, 240];

/// Side of the maps, texels.
const SIDE: u32 = 512;

/// Cosine of 85°, from which on the printed rule holds.
const BAND: f64 = 0.087_155_742_747_658_17;

/// The byte of a half.
const HALF: u8 = 128;

/// Walls that turn their faces 86° to 89.5° from the light, and posts before them whose shadows run along them.
fn walls() -> (Subject, Viewpoint) {
    let mut mesh = MeshBuilder::new("walls");
    mesh.aligned_box(DVec3::new(-30.0, -0.1, -30.0), DVec3::new(30.0, 0.0, 30.0));
    mesh.end_object();
    for (index, angle) in [86.0_f64, 87.0, 88.0, 89.0, 89.5].into_iter().enumerate() {
        // Light travels along +x: a face along x is turned towards −x by what its angle lacks of a right one.
        let turned = DMat3::from_rotation_y((angle - 90.0).to_radians());
        let centre = DVec3::new(0.0, 2.0, 8.0 - 4.0 * index as f64);
        mesh.cuboid(centre, DVec3::new(8.0, 2.0, 0.2), &turned);
        mesh.end_object();
        for post in [-7.0, -3.0, 2.0] {
            mesh.cuboid(centre + turned * DVec3::new(post, 0.0, 0.25), DVec3::new(0.1, 2.2, 0.05), &turned);
            mesh.end_object();
        }
    }
    let viewpoint = Viewpoint {
        name: "walls".to_owned(),
        eye: DVec3::new(-3.0, 9.0, 26.0),
        target: DVec3::new(0.0, 1.0, 0.0),
        up: DVec3::Y,
        fov_y: 0.8,
        near: 1.0,
        far: 100.0,
        travel: DVec3::new(1.0, -0.4, 0.0).normalize(),
        shadow_distance: 100.0,
    };
    (Subject::new(mesh.finish()), viewpoint)
}

/// What a rule does in a picture.
#[derive(Clone, Copy, Debug)]
struct Found {
    /// Share of valid pixels in which the light grazes, 85° to 90°.
    band: f64,
    /// Light and shadow where there is none, away from edges, shares of all valid pixels.
    interior: [f64; 2],
    /// Mean |v − area truth| over the pixels in which it grazes.
    grazed: f64,
    /// The same over all valid pixels away from edges.
    inside: f64,
    /// The same over all valid pixels.
    mae: f64,
}

fn measure(subject: &Subject, viewpoint: &Viewpoint, remix: &Remix, truth: &Truth, visible: &Visible) -> Found {
    let setting = setting(viewpoint);
    let seen = setting.visible_points(subject);
    let frame = remix.fit(&setting.input(subject, &seen, remix.wgsl_key(), SIDE)).expect("a legal input");
    let bytes = render(subject, visible, &frame, &setting).mask;
    // A half lies between two bytes, and was rounded up: it is neither light nor shadow.
    let value = |(byte, value): (u8, f32)| if byte == HALF { 0.5 } else { value };
    let mask: Vec<f32> = bytes.iter().copied().zip(mask_from_bytes(&bytes)).map(value).collect();
    let scores = Scores::new(&mask, truth).expect("a mask of the truth's size");
    let Light::Directional { travel } = setting.light else { panic!("a sun") };
    let grazes = |pixel: usize| {
        let cosine = -visible.pixel(pixel).map_or(-1.0, |hit| hit.normal.dot(travel));
        truth.valid[pixel] && (0.0..=BAND).contains(&cosine)
    };
    let errors = |of: &dyn Fn(usize) -> bool| -> Vec<f64> {
        let error = |pixel: usize| f64::from((mask[pixel] - truth.area[pixel]).abs());
        (0..mask.len()).filter(|&pixel| of(pixel)).map(error).collect()
    };
    let near = near_edges(truth, Edges::Area);
    let (grazed, inside) = (errors(&grazes), errors(&|pixel| truth.valid[pixel] && !near[pixel]));
    Found {
        band: grazed.len() as f64 / scores.valid_pixels as f64,
        interior: [scores.leak_interior, scores.false_interior],
        grazed: mean(&grazed),
        inside: mean(&inside),
        mae: scores.mae,
    }
}

fn setting(viewpoint: &Viewpoint) -> Setting {
    let mut case = case_of(viewpoint, "grazing");
    case.viewport = PICTURE;
    Setting::of(&case)
}

/// What the manual says of the walls: without the rule, as printed, and as a continuous one.
fn as_quoted(name: &str, [off, printed, continuous]: [Found; 3]) {
    let quoted: &[(f64, f64)] = match name {
        "fsm" => &[(off.grazed, 0.21), (printed.grazed, 0.49), (continuous.grazed, 0.45)],
        "fsm, constant bias" => &[(off.grazed, 0.39)],
        _ => &[],
    };
    for &(found, quoted) in quoted {
        support::as_quoted(name, found, quoted, 0.006);
    }
}

#[test]
fn the_rule_answers_a_half_where_light_grazes() {
    let across = sparse_city_viewpoints().swap_remove(0);
    println!("{SIDE}² maps, {} × {} pixels; all figures in %.", PICTURE[0], PICTURE[1]);
    println!(
        "| scene | technique | rule | pixels 85° to 90° | leak interior | false interior | mean error there | mean error away from edges | mean error |"
    );
    println!("|---|---|---|--:|--:|--:|--:|--:|--:|");
    for (subject, viewpoint) in [walls(), (Subject::new(sparse_city()), across)] {
        let mut case = case_of(&viewpoint, "grazing");
        case.viewport = PICTURE;
        let truth = Truth::trace(&case, &subject.model, &|| {});
        let visible = Visible::draw(&subject.model, &setting(&viewpoint).camera, setting(&viewpoint).origin);
        // The automatic bias, and a constant one as small as papers have it.
        let naked = Bias::Manual { depth_world: 0.02, slope_texels: 0.0, normal_texels: 0.0 };
        let techniques = [
            ("fsm", techniques::fsm()),
            ("fsm, constant bias", Remix { bias: naked, ..techniques::fsm() }),
            ("smra", techniques::smra()),
        ];
        for (name, technique) in techniques {
            let found = Grazing::ALL.map(|grazing| {
                let found = measure(&subject, &viewpoint, &Remix { grazing, ..technique }, &truth, &visible);
                let [leak, acne] = found.interior.map(|share| 100.0 * share);
                let Found { band, grazed, inside, mae, .. } = found;
                println!(
                    "| {} | {name} | {grazing:?} | {:.2} | {leak:.3} | {acne:.3} | {:.2} | {:.2} | {:.2} |",
                    viewpoint.name,
                    100.0 * band,
                    100.0 * grazed,
                    100.0 * inside,
                    100.0 * mae
                );
                found
            });
            let [off, printed, continuous] = found;
            assert!(off.band > 0.001, "{name}: the light grazes somewhere: {off:?}");
            // A half is within a half of everything, and by a half off where all is light or shadow.
            for rule in [printed, continuous] {
                let [leak, acne] = rule.interior;
                assert!(leak <= off.interior[0] && acne <= off.interior[1], "{name}: {rule:?} and {off:?}");
                assert!(rule.grazed <= 0.5 + 0.01, "{name}: {rule:?}");
            }
            assert!(printed.grazed > 0.35, "{name}: {printed:?}");
            // Why the rule is off unless it is asked for: what the maps say there is nearer to the truth.
            assert!(off.grazed < printed.grazed && off.grazed < continuous.grazed, "{name}: {off:?}");
            if viewpoint.name == "walls" {
                assert!(off.inside < printed.inside && off.inside < continuous.inside, "{name}: {off:?}");
                as_quoted(name, found);
            }
        }
    }
}
