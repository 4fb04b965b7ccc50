//! A million sets of depths: lit is a share, never NaN; bounds are bounds; two surfaces are exact.

use antumbra::encoding::convolution::{antumbra_convolution_lit, antumbra_convolution_part};
use antumbra::encoding::exponential::{
    antumbra_exponential_lit, antumbra_exponential_variance_lit, antumbra_exponential_variance_lit_two,
};
use antumbra::encoding::moments::{ANTUMBRA_MOMENTS_BIAS, antumbra_moments_lit, antumbra_moments_lit_within};
use antumbra::encoding::variance::{antumbra_darkened, antumbra_variance_lit};
use glam::{Vec2, Vec4, Vec4Swizzles};

use crate::dice::Dice;
use crate::sets::Set;

const SETS: u32 = 1_000_000;

/// What f32 may take from a variance of numbers up to ½: nine products and sums of numbers up to ¼.
const LOSS: f32 = 5e-7;

/// The same as a standard deviation of depth: bent depths lose as much of themselves.
const BLUR: f32 = 1e-4;

/// All ways to read a set at a depth.
fn all(set: &Set, depth: f32) -> [f32; 7] {
    let (strong, weak) = (Vec2::new(40.0, 8.0), Vec2::splat(5.54));
    let convolution = (0..8).step_by(2).map(|term| antumbra_convolution_part(set.convolution(term), depth, term));
    let bent = set.exponential_variance(strong);
    [
        antumbra_variance_lit(set.variance(), depth, LOSS),
        antumbra_exponential_variance_lit_two(bent.xy(), depth, strong, BLUR),
        antumbra_exponential_variance_lit(set.exponential_variance(weak), depth, weak, BLUR),
        antumbra_moments_lit(set.moments(), depth, ANTUMBRA_MOMENTS_BIAS),
        antumbra_moments_lit_within(set.moments(), depth, ANTUMBRA_MOMENTS_BIAS),
        antumbra_exponential_lit(set.exponential(80.0), depth, 80.0),
        antumbra_convolution_lit(0.5 + convolution.sum::<f32>()),
    ]
}

const NAMES: [&str; 7] = ["variance", "EVSM2 40", "EVSM4 5.54", "Hamburger", "Hausdorff", "exponential", "convolution"];

#[test]
fn shares_are_shares_and_bounds_are_bounds() {
    let mut dice = Dice::new(7);
    // How far below the truth each is at worst, how often by more than 0.01, and how far above in the mean.
    let (mut worst, mut often, mut above) = ([0.0_f64; 7], [0_u32; 7], [0.0_f64; 7]);
    let mut order = 0.0_f32;
    for _ in 0..SETS {
        let set = Set::hostile(&mut dice);
        let depth = set.receiver(&mut dice);
        let truth = set.lit(depth);
        let lit = all(&set, depth);
        for (index, lit) in lit.into_iter().enumerate() {
            assert!((0.0..=1.0).contains(&lit), "{}: {lit} for {set:?} at {depth}", NAMES[index]);
            let below = truth - f64::from(lit);
            worst[index] = worst[index].max(below);
            often[index] += u32::from(below > 0.01);
            above[index] += (-below).max(0.0);
        }
        order = order.max(lit[4] - lit[3]);
    }
    for (index, name) in NAMES.iter().enumerate() {
        println!(
            "{name:12} below the truth by at most {:.1e}, by more than 0.01 in {} of {SETS}; above by {:.4} in the mean",
            worst[index],
            often[index],
            above[index] / f64::from(SETS)
        );
    }
    println!("Hausdorff above Hamburger by at most {order:.1e}");
    // Bounds: what is left is rounding.
    assert!(worst[..4].iter().all(|below| *below < 1e-5), "{worst:?}");
    assert!(worst[4] < 5e-3, "{worst:?}");
    assert!(order <= 0.0, "{order}");
    // More moments let less through.
    assert!(above[4] < above[3] && above[3] < above[2] && above[2] < above[0], "{above:?}");
    // A series is no bound: it rings.
    assert!(worst[6] > 0.05, "{worst:?}");
}

/// Two surfaces, of which one is the receiver's: all bounds that know two moments or more are the truth.
#[test]
fn two_surfaces_are_exact() {
    let mut dice = Dice::new(8);
    let mut worst = [0.0_f64; 5];
    for _ in 0..100_000 {
        let (near, far) = (dice.single(0.0, 0.4), dice.single(0.6, 1.0));
        let share = dice.single(0.0, 1.0);
        let set = Set(vec![(near, share), (far, 1.0 - share)]);
        for (worst, lit) in worst.iter_mut().zip(all(&set, far)) {
            *worst = worst.max((f64::from(lit) - f64::from(1.0 - share)).abs());
        }
    }
    println!("two surfaces: {worst:?}");
    assert!(worst.iter().all(|off| *off < 1e-3), "{worst:?}");
}

/// Numbers that no set of depths has: still a share, never NaN.
#[test]
fn poisoned_moments_read_as_shares() {
    let poison = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.4, -3.4, 1e38, 0.0, 1.0];
    let mut dice = Dice::new(9);
    for _ in 0..100_000 {
        let any = |dice: &mut Dice| poison[dice.below(poison.len())];
        let moments = Vec4::from_array(core::array::from_fn(|_| any(&mut dice)));
        let depth = dice.single(0.0, 1.0);
        let exponents = Vec2::new(40.0, 8.0);
        for lit in [
            antumbra_variance_lit(moments.xy(), depth, LOSS),
            antumbra_exponential_variance_lit_two(moments.xy(), depth, exponents, BLUR),
            antumbra_exponential_variance_lit(moments, depth, exponents, BLUR),
            antumbra_moments_lit(moments, depth, ANTUMBRA_MOMENTS_BIAS),
            antumbra_moments_lit_within(moments, depth, ANTUMBRA_MOMENTS_BIAS),
            antumbra_exponential_lit(moments.x, depth, 80.0),
            antumbra_convolution_lit(0.5 + antumbra_convolution_part(moments, depth, 0)),
            antumbra_darkened(antumbra_variance_lit(moments.xy(), depth, LOSS), 0.2),
        ] {
            assert!((0.0..=1.0).contains(&lit), "{lit} for {moments} at {depth}");
        }
    }
}
