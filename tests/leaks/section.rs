//! Light behind a caster, by distance: what the exponential leaks at contacts, and how a series rings.

use antumbra::encoding::convolution::{
    ANTUMBRA_CONVOLUTION_RANGE, antumbra_convolution_lit, antumbra_convolution_part, antumbra_convolution_terms,
};
use antumbra::encoding::read::{antumbra_read, antumbra_store};
use antumbra::{CONVOLUTION_TERMS, MomentFormat, MomentKind, Moments};
use glam::Vec2;

/// Depth of the caster, which is all that the filter sees.
const CASTER: f32 = 0.3;

/// The series before it is clamped, behind a caster, with so many terms.
fn series(terms: u32, behind: f32) -> f32 {
    let part = |term| antumbra_convolution_part(antumbra_convolution_terms(CASTER, term), CASTER + behind, term);
    (0..terms).step_by(2).fold(0.5, |sum, term| sum + part(term))
}

/// Light at a distance behind the caster.
fn lit(kind: MomentKind, behind: f32) -> f32 {
    if kind == MomentKind::Convolution {
        return antumbra_convolution_lit(series(CONVOLUTION_TERMS, behind));
    }
    let moments = Moments::new(kind, MomentFormat::Float32);
    antumbra_read(moments, antumbra_store(moments, CASTER, 0), CASTER + behind, Vec2::ZERO)
}

/// The greatest value of a function between two distances, and where.
fn most(of: impl Fn(f32) -> f32, from: f32, to: f32) -> (f32, f32) {
    let places = (0..=2000).map(|step| from + (to - from) * step as f32 / 2000.0);
    places.map(|at| (of(at), at)).max_by(|a, b| a.0.total_cmp(&b.0)).expect("places")
}

/// ESM's contact leak: e^(−c d), half of the light at 0.87 % of the depth range behind its caster.
/// CSM's ringing: overshoot of the step by 9 % at 1/(2M) of the range, whatever M, and fading light of every second
/// lobe deeper in.
#[test]
fn contacts_leak_and_series_ring() {
    let distances = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4];
    println!("Light behind a lone caster, %, by distance in % of the depth range; 32 bits.");
    println!("| encoding | {} |", distances.map(|d| format!("{:.1}", 100.0 * d)).join(" | "));
    for kind in MomentKind::ALL {
        println!("| {} | {} |", kind.name(), distances.map(|d| format!("{:.2}", 100.0 * lit(kind, d))).join(" | "));
    }
    println!(
        "\nThe series before it is clamped: overshoot in front, at a distance in % of the range; greatest light of the lobes behind."
    );
    println!("| terms | overshoot, % | at | bytes | lit, % | at |\n|--:|--:|--:|--:|--:|--:|");
    for terms in [2, 4, 8, 16] {
        let (over, at) = most(|d| series(terms, -d), 0.0, 0.25);
        // Behind the first zero: what is light there is the ring.
        let first = 1.0 / terms as f32 / ANTUMBRA_CONVOLUTION_RANGE;
        let (ring, ring_at) = most(|d| antumbra_convolution_lit(series(terms, d)), first, 0.6);
        println!(
            "| {terms} | {:.2} | {:.2} | {} | {:.2} | {:.1} |",
            100.0 * (over - 1.0),
            100.0 * at,
            2 * terms,
            100.0 * ring,
            100.0 * ring_at
        );
        assert!((over - 1.0897).abs() < 0.02, "{terms} terms overshoot to {over}");
        let half_period = 0.5 / terms as f32 / ANTUMBRA_CONVOLUTION_RANGE;
        assert!((at - half_period).abs() < 0.15 * half_period, "{terms} terms: at {at}, not {half_period}");
    }
    // The exponential's law, and that two-sided moments do not leak at contacts beyond what rounding needs.
    let c = Moments::new(MomentKind::Exponential, MomentFormat::Float32).exponent();
    assert!((lit(MomentKind::Exponential, 1.0 / c) - (-1.0_f32).exp()).abs() < 1e-3);
    for kind in [MomentKind::Hamburger, MomentKind::Hausdorff] {
        assert!(lit(kind, 0.01) < 0.01, "{}: {}", kind.name(), lit(kind, 0.01));
    }
}
