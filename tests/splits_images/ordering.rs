//! Where parallel splits stand among single maps.

use antumbra::lab::cpu;
use antumbra::lab::metrics::{Scores, mask_from_bytes};
use antumbra::{DepthSplits, MAX_VIEWS, Remix, ShadowTechnique, Split, techniques};

use crate::over_built_in;

/// Side of each map, texels.
const SIDE: u32 = 512;

/// Least share that counts, one pixel or so: none wrong at all has no logarithm.
const LEAST: f64 = 1e-5;

/// Three parallel splits are better than one standard map and one trapezoidal map of the same side.
#[test]
fn parallel_splits_are_better_than_single_maps() {
    let printed = Remix { guard: false, ..techniques::tsm() };
    let all = [
        ("pssm", techniques::pssm()),
        ("ssm", techniques::ssm()),
        ("tsm", techniques::tsm()),
        ("tsm as printed", printed),
    ];
    println!("Wrong pixels against centre truth, percent; maps of {SIDE}.");
    println!("| case | {} |", all.map(|(name, _)| name).join(" | "));
    println!("|---|--:|--:|--:|--:|");
    let mut logarithms: Vec<[f64; 4]> = Vec::new();
    over_built_in(|place| {
        let truth = place.truth();
        let wrong = all.map(|(_, remix)| {
            let input = place.setting.input(place.subject, &[], remix.wgsl_key(), SIDE);
            let frame = remix.fit(&input).expect("a legal case");
            let image = cpu::render(place.subject, &place.visible, &frame, &place.setting);
            Scores::new(&mask_from_bytes(&image.mask), &truth).expect("a mask of the right size").wrong_center
        });
        println!("| {} | {} |", place.name, wrong.map(|wrong| format!("{:.3}", 100.0 * wrong)).join(" | "));
        logarithms.push(wrong.map(|wrong| wrong.max(LEAST).ln()));
    });
    let mean = |index: usize| {
        let sum: f64 = logarithms.iter().map(|case| case[index]).sum();
        (sum / logarithms.len() as f64).exp()
    };
    let means = [0, 1, 2, 3].map(mean);
    println!("| geometric mean | {} |", means.map(|wrong| format!("{:.3}", 100.0 * wrong)).join(" | "));
    let [pssm, ssm, _, printed] = means;
    assert!(pssm < ssm, "{pssm} against {ssm}");
    assert!(pssm < printed, "{pssm} against {printed}");
}

/// Texels of a map that is sharper than the picture, so that a warp which is too strong shows.
const FINE: u32 = 1024;

/// Planes a little nearer than those of least error show hardly more wrong pixels: a map whose warp is for its own
/// slice alone would be coarse for all that it holds behind it.
#[test]
fn planes_may_be_a_little_off() {
    let mut worst = 0.0_f64;
    over_built_in(|place| {
        let (truth, seen) = (place.truth(), place.setting.visible_points(place.subject));
        let shoot = |remix: &Remix| {
            let input = place.setting.input(place.subject, &seen, remix.wgsl_key(), FINE);
            let frame = remix.fit(&input).expect("a legal case");
            let image = cpu::render(place.subject, &place.visible, &frame, &place.setting);
            let scores = Scores::new(&mask_from_bytes(&image.mask), &truth).expect("a mask of the right size");
            (scores.wrong_center.max(LEAST), frame)
        };
        let (right, frame) = shoot(&techniques::cascades());
        let mut planes = [0.0; MAX_VIEWS - 1];
        let between = &frame.uniforms.views[1..frame.views.len()];
        planes.iter_mut().zip(between).for_each(|(plane, view)| *plane = 0.97 * view.domain[0]);
        let split = Split::Depth(DepthSplits::manual(&planes[..between.len()]));
        let (off, _) = shoot(&Remix { split, ..techniques::cascades() });
        println!("{}: {:.3} %, planes nearer {:.3} %", place.name, 100.0 * right, 100.0 * off);
        worst = worst.max(off / right);
    });
    assert!(worst < 1.5, "{worst}");
}
