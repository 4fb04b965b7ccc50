//! Cards over each other: light where there is none.

use antumbra::lab::cli::encode_png;
use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::metrics::{Scores, mask_from_bytes};
use antumbra::lab::stack::{stack, stack_viewpoint};
use antumbra::lab::subject::{Setting, Subject, case_of};
use antumbra::lab::truth::Truth;
use antumbra::{Encoding, MomentFormat, MomentKind, Pcf, Remix, ShadowTechnique, techniques};
use image::ExtendedColorType;

use crate::encodings::{formats, moments};

/// Width and height of the picture, pixels.
const PICTURE: [u32; 2] = [640, 480];

/// Side of the map, texels: one is about a pixel.
const SIDE: u32 = 512;

/// Half-width of every blur, texels: that of the reference, which is compared first and averaged then.
const RADIUS: f32 = 2.5;

/// How far from an edge of the truth a filter of that width may show it, pixels.
const REACH: usize = 7;

/// Most that four moments, and two exponentials, may leave of what two moments leak.
const MOST: f64 = 0.25;

/// Shares of what variance leaks that the manual has.
const QUOTED: [(MomentKind, f64); 3] = [
    (MomentKind::ExponentialVarianceFour, 0.22),
    (MomentKind::Hamburger, 1.0 / 60.0),
    (MomentKind::Hausdorff, 1.0 / 60.0),
];

/// Most that 16-bit integers may leak beyond 32 bits, a factor.
const AS_MUCH: f64 = 1.5;

/// What a picture shows that is not there, away from edges, means over the valid pixels.
#[derive(Clone, Copy)]
struct Found {
    leak: f64,
    shadow: f64,
    wrong_leak: f64,
    excess: f64,
}

/// Valid pixels further than [`REACH`] from every edge.
fn interior(truth: &Truth) -> Vec<bool> {
    let (width, height) = (truth.width as usize, truth.height as usize);
    let edge = |x: usize, y: usize| {
        let at = y * width + x;
        let cut = truth.area[at] > 0.0 && truth.area[at] < 1.0;
        let differs = |other: usize| truth.valid[other] && truth.centre[other] != truth.centre[at];
        truth.valid[at] && (cut || (x + 1 < width && differs(at + 1)) || (y + 1 < height && differs(at + width)))
    };
    let edges: Vec<bool> = (0..width * height).map(|at| edge(at % width, at / width)).collect();
    let near = |low: usize, high: usize| low.saturating_sub(REACH)..=(low + REACH).min(high - 1);
    let rows: Vec<bool> =
        (0..edges.len()).map(|at| near(at % width, width).any(|x| edges[at / width * width + x])).collect();
    let away = |at: usize| truth.valid[at] && !near(at / width, height).any(|y| rows[y * width + at % width]);
    (0..edges.len()).map(away).collect()
}

struct Stage {
    subject: Subject,
    setting: Setting,
    visible: Visible,
    truth: Truth,
    interior: Vec<bool>,
}

impl Stage {
    fn new() -> Self {
        let subject = Subject::new(stack());
        let mut case = case_of(&stack_viewpoint(), "stack");
        case.viewport = PICTURE;
        let setting = Setting::of(&case);
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        let truth = Truth::trace(&case, &subject.model, &|| {});
        let interior = interior(&truth);
        Self { subject, setting, visible, truth, interior }
    }

    fn mask(&self, encoding: Encoding) -> Vec<f32> {
        let remix = Remix { encoding, ..techniques::fsm() };
        let frame =
            remix.fit(&self.setting.input(&self.subject, &[], remix.wgsl_key(), SIDE)).expect("a legal setting");
        mask_from_bytes(&cpu::render(&self.subject, &self.visible, &frame, &self.setting).mask)
    }

    fn found(&self, mask: &[f32]) -> Found {
        let mean = |sign: f32| {
            let error = |at: usize| f64::from(((mask[at] - self.truth.centre[at]) * sign).max(0.0));
            let sum: f64 = (0..mask.len()).filter(|at| self.interior[*at]).map(error).sum();
            sum / self.truth.valid_count() as f64
        };
        let scores = Scores::new(mask, &self.truth).expect("a mask of the truth's size");
        Found { leak: mean(1.0), shadow: mean(-1.0), wrong_leak: scores.leak_interior, excess: scores.excess }
    }
}

fn save(name: &str, mask: &[f32]) {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("leaks");
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    let bytes: Vec<u8> = mask.iter().map(|value| (value * 255.0).round() as u8).collect();
    let png = encode_png(&bytes, PICTURE[0], PICTURE[1], ExtendedColorType::L8).expect("a picture");
    std::fs::write(folder.join(format!("{}.png", name.replace([' ', ','], "-"))), png).expect("a writable folder");
}

#[test]
fn overlapping_cards_leak_less_with_more_moments() {
    let stage = Stage::new();
    println!("Away from edges, % of the light over valid pixels; excess: mean error above the hard edge's, %.");
    println!("| encoding | dark | leak | more than half lit | false shadow | excess |\n|---|--:|--:|--:|--:|--:|");
    let say = |name: &str, dark: f32, mask: &[f32]| {
        let found = stage.found(mask);
        let [leak, wrong, shadow, excess] =
            [found.leak, found.wrong_leak, found.shadow, found.excess].map(|x| 100.0 * x);
        println!("| {name} | {dark} | {leak:.4} | {wrong:.4} | {shadow:.4} | {excess:.3} |");
        save(&format!("{name} {dark}"), mask);
        found
    };
    save("truth", &stage.truth.area);
    let reference = say("PCF 5×5", 0.0, &stage.mask(Encoding::Depth(Pcf::Box5x5)));
    assert!(reference.leak < 1e-5, "the reference leaks {}", reference.leak);
    let mut leaks = Vec::new();
    for (name, kind, format) in formats() {
        for dark in [0.0, 0.2] {
            let found = say(&name, dark, &stage.mask(moments(kind, format, RADIUS, dark)));
            leaks.push((kind, format, dark, found.leak));
        }
    }
    let in_format = |kind, format| {
        let same = |(k, f, d, _): &&(_, _, _, _)| (*k, *f, *d) == (kind, format, 0.0);
        leaks.iter().find(same).expect("measured").3
    };
    let of = |kind| in_format(kind, MomentFormat::Float32);
    let two = of(MomentKind::Variance);
    for kind in [MomentKind::ExponentialVarianceFour, MomentKind::Hamburger, MomentKind::Hausdorff] {
        assert!(of(kind) <= MOST * two, "{}: {} of {two}", kind.name(), of(kind));
    }
    // What the manual says of them, to a twentieth.
    for (kind, quoted) in QUOTED {
        let share = of(kind) / two;
        println!("{} leaks {share:.4} of what variance does, the manual says {quoted:.4}", kind.name());
        assert!((share / quoted - 1.0).abs() <= 0.05, "{}: {share}, and README.md says {quoted}", kind.name());
    }
    // Integers of 16 bits hold as much.
    for kind in [MomentKind::Variance, MomentKind::Hamburger, MomentKind::Hausdorff] {
        let (less, more) = (in_format(kind, MomentFormat::Unorm16), of(kind));
        assert!(less <= AS_MUCH * more, "{}: {less} of {more}", kind.name());
    }
}
