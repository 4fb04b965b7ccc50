//! A thin fence far away, seen by a camera that walks past: change that the truth does not have.

use antumbra::lab::cpu::Visible;
use antumbra::lab::metrics::flicker;
use antumbra::lab::shapes::MeshBuilder;
use antumbra::lab::subject::{Setting, Subject, case_of};
use antumbra::lab::truth::Truth;
use antumbra::lab::viewpoints::Viewpoint;
use antumbra::{Encoding, MomentFormat, MomentKind, Moments, Pcf, Prefilter, Remix, ShadowTechnique, techniques};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::drawn::Drawn;

/// Frames of the walk, and metres from one to the next: a tenth of a pixel at the fence.
const FRAMES: usize = 48;
const STEP: f64 = 0.025;

/// Width and height of the picture, pixels: one is 0.25 m at the fence, eight texels of the map.
const PICTURE: [u32; 2] = [120, 90];

/// Side of the map, texels of 3 cm: pickets are there, and pixels miss them.
const SIDE: u32 = 1024;

/// Pickets, and metres from one to the next.
const PICKETS: i32 = 120;
const PITCH: f64 = 0.15;

/// Most flicker that moments with mips may have, as a share of point sampling's.
const MOST: f64 = 0.5;

fn fence() -> Subject {
    let mut mesh = MeshBuilder::new("fence");
    mesh.aligned_box(DVec3::new(-12.0, -0.1, -14.0), DVec3::new(12.0, 0.0, 10.0));
    mesh.end_object();
    for picket in 0..PICKETS {
        let x = (f64::from(picket) - 0.5 * f64::from(PICKETS)) * PITCH;
        mesh.cuboid(DVec3::new(x, 0.7, 0.0), DVec3::new(0.035, 0.7, 0.01), &DMat3::IDENTITY);
    }
    Subject::new(mesh.finish())
}

/// One frame: what is seen, and what is true.
struct Frame {
    setting: Setting,
    visible: Visible,
    truth: Truth,
}

fn frame(subject: &Subject, index: usize) -> Frame {
    let walked = DVec3::X * (STEP * index as f64);
    let viewpoint = Viewpoint {
        name: "fence-walk".to_owned(),
        eye: DVec3::new(-1.0, 7.0, 28.0) + walked,
        target: DVec3::new(-1.0, 0.0, -3.0) + walked,
        up: DVec3::Y,
        fov_y: 0.75,
        near: 1.0,
        far: 100.0,
        travel: DVec3::new(0.35, -0.6, -0.75).normalize(),
        shadow_distance: 100.0,
    };
    let mut case = case_of(&viewpoint, "fence");
    case.viewport = PICTURE;
    let setting = Setting { origin: DVec3::ZERO, ..Setting::of(&case) };
    let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
    Frame { truth: Truth::trace(&case, &subject.model, &|| {}), setting, visible }
}

/// Mean flicker of a technique, whose uniform map stands still, and its mean error.
fn measure(subject: &Subject, frames: &[Frame], encoding: Encoding) -> [f64; 2] {
    let remix = Remix { encoding, ..techniques::ssm() };
    let input = |frame: &Frame| frame.setting.input(subject, &[], remix.wgsl_key(), SIDE);
    let mut drawn = Drawn::new(&subject.model, &input(&frames[0]), &remix);
    let masks: Vec<Vec<f32>> = frames
        .iter()
        .map(|frame| {
            drawn.frame = remix.fit(&input(frame)).expect("a legal input");
            let lit = |pixel: usize| {
                let hit = frame.visible.pixel(pixel)?;
                Some(drawn.lit(hit.position.as_vec3(), hit.normal.as_vec3()).clamp(0.0, 1.0))
            };
            (0..frame.truth.valid.len()).into_par_iter().map(|pixel| lit(pixel).unwrap_or(1.0)).collect()
        })
        .collect();
    let pairs = frames.windows(2).zip(masks.windows(2));
    let change = |(frames, masks): (&[Frame], &[Vec<f32>])| {
        flicker((&masks[0], &frames[0].truth), (&masks[1], &frames[1].truth)).expect("masks of the truth's size")
    };
    let error = |(frame, mask): (&Frame, &Vec<f32>)| {
        let valid = (0..mask.len()).filter(|at| frame.truth.valid[*at]);
        let sum: f64 = valid.map(|at| f64::from((mask[at] - frame.truth.area[at]).abs())).sum();
        sum / frame.truth.valid_count() as f64
    };
    [
        pairs.map(change).sum::<f64>() / (FRAMES - 1) as f64,
        frames.iter().zip(&masks).map(error).sum::<f64>() / FRAMES as f64,
    ]
}

#[test]
fn moments_with_mips_flicker_half_as_much() {
    let subject = fence();
    let frames: Vec<Frame> = (0..FRAMES).map(|index| frame(&subject, index)).collect();
    println!("A thin fence far away, {FRAMES} frames: flicker (mean |Δv − Δt|) and mean error, %.");
    println!("| technique | flicker | ÷ point | error |\n|---|--:|--:|--:|");
    let point = measure(&subject, &frames, Encoding::Depth(Pcf::Point));
    let say = |name: &str, [change, error]: [f64; 2]| {
        println!("| {name} | {:.3} | {:.2} | {:.2} |", 100.0 * change, change / point[0], 100.0 * error);
    };
    say("point", point);
    for filter in [Pcf::Hardware2x2, Pcf::Box3x3, Pcf::Box5x5] {
        say(filter.name(), measure(&subject, &frames, Encoding::Depth(filter)));
    }
    let mut broken = Vec::new();
    for kind in MomentKind::ALL {
        for mips in [false, true] {
            let moments = Moments::new(kind, MomentFormat::Float32);
            let found = measure(&subject, &frames, Encoding::Moments(Prefilter::of(moments.read(true, mips))));
            say(&format!("{}{}", kind.name(), if mips { ", mips" } else { "" }), found);
            if mips && !(found[0] <= MOST * point[0]) {
                broken.push(format!("{}: {}", kind.name(), found[0] / point[0]));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}
