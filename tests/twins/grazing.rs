//! The rule for grazing light: what it is at known angles, that the continuous form has no step of its own, and the
//! shader against its twin.

use antumbra::encoding::depth::DepthMap;
use antumbra::encoding::grazing::antumbra_grazing;
use antumbra::encoding::split::antumbra_visibility;
use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor};
use antumbra::wgsl::{self, Bindings};
use antumbra::{Grazing, MapBudget, Pcf, Select, ShadowFrame, ViewUniforms, WgslKey};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, UVec2, Vec3, Vec4};

use crate::cases::frame;
use crate::dice::Dice;
use crate::support::compute::compute;
use crate::{adapter, support};

/// A row of light along (0.6, −0.8, 0) through a depth of 40 units.
fn row() -> Vec4 {
    Vec4::new(0.6, -0.8, 0.0, 7.0) / 40.0
}

/// A normal at an angle to where that light comes from, degrees.
fn normal(degrees: f64) -> Vec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    (DVec3::new(-0.6, 0.8, 0.0) * cosine + DVec3::new(0.8, 0.6, 0.0) * sine).as_vec3()
}

/// Visibility of a receiver that its map holds to be in shadow (0) or lit (1).
fn visibility(grazing: Grazing, degrees: f64, mapped: f32) -> f32 {
    let key = WgslKey { grazing, ..WgslKey::default() };
    let mut frame = ShadowFrame::lit(key, MapBudget::one(1));
    let mut view = ViewUniforms { depth_from_render: row().to_array(), ..ViewUniforms::LIT };
    view.depth_from_render[3] = 0.5;
    frame.uniforms.views[0] = view;
    let map = DepthMap { size: UVec2::ONE, depth: &[mapped] };
    antumbra_visibility(key, &frame.uniforms, &[map], Vec3::ZERO, normal(degrees), 1.0)
}

#[test]
fn known_angles() {
    for mapped in [0.0, 1.0] {
        let printed = |degrees| visibility(Grazing::Printed, degrees, mapped).to_bits();
        let expected = |value: f32| value.to_bits();
        for outside in [0.0, 60.0, 84.9, 84.999, 90.001, 90.1, 120.0, 180.0] {
            assert_eq!(printed(outside), expected(mapped), "{outside}°");
        }
        for inside in [85.001, 85.1, 87.0, 89.999] {
            assert_eq!(printed(inside), expected(0.5), "{inside}°");
        }
        // Off, and the continuous form beside and beyond its band; at 85° by hand: t = 0.501145.
        for degrees in [0.0, 84.9, 85.1, 90.0, 120.0] {
            assert_eq!(visibility(Grazing::Off, degrees, mapped).to_bits(), expected(mapped), "{degrees}°");
        }
        let continuous = |degrees| visibility(Grazing::Continuous, degrees, mapped);
        for (degrees, value) in [(0.0, mapped), (81.99, mapped), (88.01, 0.5), (90.0, 0.5), (150.0, 0.5)] {
            assert_eq!(continuous(degrees).to_bits(), expected(value), "{degrees}°");
        }
        let half_way = mapped + (0.5 - mapped) * 0.498_281_8;
        assert!((continuous(85.0) - half_way).abs() < 1e-5, "{} and {half_way}", continuous(85.0));
    }
    // A right angle exactly.
    let row = Vec4::new(0.0, -0.1, 0.0, 0.3);
    assert_eq!(antumbra_grazing(Grazing::Printed, Vec3::X, row).to_bits(), 1.0_f32.to_bits());
    assert_eq!(antumbra_grazing(Grazing::Continuous, Vec3::X, row).to_bits(), 1.0_f32.to_bits());
}

/// Without a light there is no angle, and without a normal neither: views that are not in use read lit.
#[test]
fn nothing_to_measure_leaves_everything() {
    for grazing in Grazing::ALL {
        let none = Vec4::from_array(ViewUniforms::LIT.depth_from_render);
        for share in [antumbra_grazing(grazing, Vec3::X, none), antumbra_grazing(grazing, Vec3::ZERO, row())] {
            assert_eq!(share.to_bits(), 0.0_f32.to_bits(), "{grazing:?}");
        }
        let key = WgslKey { grazing, ..WgslKey::default() };
        let lit = ShadowFrame::lit(key, MapBudget::one(1));
        let map = DepthMap { size: UVec2::ONE, depth: &[0.5] };
        let seen = antumbra_visibility(key, &lit.uniforms, &[map], Vec3::ONE, Vec3::X, 1.0);
        assert_eq!(seen.to_bits(), 1.0_f32.to_bits(), "{grazing:?}");
    }
}

/// Over a wall that turns away from the light, the continuous form changes no faster than its smoothstep: 3/2 over the
/// width of its band, halved. The printed one leaps by a half.
#[test]
fn the_continuous_form_has_no_step() {
    let steps = 100_000;
    let angle = |step: u32| 70.0 + 40.0 * f64::from(step) / f64::from(steps);
    let largest = |grazing| {
        let changes = (1..=steps)
            .map(|step| (visibility(grazing, angle(step), 0.0) - visibility(grazing, angle(step - 1), 0.0)).abs());
        changes.fold(0.0_f32, f32::max)
    };
    let per_step = (angle(1) - angle(0)).to_radians();
    let band = 82.0_f64.to_radians().cos() - 88.0_f64.to_radians().cos();
    // The steepest slope of half a smoothstep, and what f32 rounds of its argument and of the cosine.
    let most = 0.5 * 1.5 / band * per_step + 4.0 * f64::from(f32::EPSILON) / band;
    let [printed, continuous] = [Grazing::Printed, Grazing::Continuous].map(|grazing| f64::from(largest(grazing)));
    assert!(continuous <= most && continuous > 0.5 * most, "{continuous:e} of {most:e}");
    assert!((printed - 0.5).abs() < 1e-6, "{printed}");
}

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Case {
    /// Position, and the eye depth.
    position: Vec4,
    normal: Vec4,
}

/// Cases of each key.
const CASES: usize = 4_096;

/// By how much a cosine may be off: a dot product of unit vectors and a length, a few roundings each.
const COSINE: f32 = 1e-6;

/// The adapter gives what the rule and the same key without it give together.
#[test]
fn twins_agree_on_grazing_light() {
    let Some(gpu) = support::gpu() else { return };
    let one = WgslKey::default();
    let several = WgslKey { maps: 2, select: Select::Finest, blend: true, ..one };
    for key in [one, WgslKey { filter: Pcf::Disc, ..one }, several, WgslKey { select: Select::Depth, ..several }] {
        let mut dice = Dice::new(0x6AA2_1261 ^ u64::from(key.maps) << 8 ^ key.filter as u64);
        let fitted = frame(&mut dice, WgslKey { filter: key.filter, ..one }, 64, 0);
        let cases: Vec<Case> = (0..CASES).map(|_| case(&mut dice, &fitted)).collect();
        let run = |grazing| -> Vec<f32> {
            let key = WgslKey { grazing, ..key };
            let map = MapBudget { side: 64, layers: u32::from(key.maps), views: u32::from(key.maps) };
            let mut frame = fitted.clone();
            (frame.wgsl, frame.map) = (key, map);
            let maps = ShadowMaps::new(gpu.device(), &ShadowMapsDescriptor { label: None, key, map }).unwrap();
            maps.prepare(gpu.queue(), &frame).unwrap();
            // Nearest or farthest: rounding decides about no comparison.
            let mut dice = Dice::new(7);
            let depth: Vec<f32> = (0..64 * 64).map(|_| dice.below(2) as f32).collect();
            adapter::fill(&gpu, &maps, &frame.views[0], &depth);
            let call = "fn visibility(position: vec3f, normal: vec3f, view_depth: f32, noise: f32) -> f32 {
                return antumbra_visibility(position, normal, view_depth); }";
            let library = wgsl::module(key, Bindings { group: 1, first: 0 });
            compute(
                &gpu,
                &[library.as_str(), include_str!("many.wgsl"), call].join("\n"),
                &cases,
                &maps.bind_entries(0),
            )
        };
        let row = Vec4::from_array(fitted.uniforms.views[0].depth_from_render);
        let mapped = run(Grazing::Off);
        for grazing in [Grazing::Printed, Grazing::Continuous] {
            let mut tally = [0_usize; 3];
            for ((case, mapped), shader) in cases.iter().zip(&mapped).zip(run(grazing)) {
                // On both sides of what rounding may do to the cosine.
                let normal = case.normal.truncate();
                let light = -row.truncate().normalize();
                let twins = [-COSINE, 0.0, COSINE].map(|off| {
                    let moved = if normal == Vec3::ZERO { normal } else { normal + light * off };
                    let grazed = antumbra_grazing(grazing, moved, row);
                    mapped * (1.0 - grazed) + 0.5 * grazed
                });
                let (low, high) = (twins.into_iter().reduce(f32::min), twins.into_iter().reduce(f32::max));
                let (low, high) = (low.unwrap() - 1e-6, high.unwrap() + 1e-6);
                assert!((low..=high).contains(&shader), "{key:?} {grazing:?}: {shader}, {low} to {high}: {case:?}");
                let grazed = antumbra_grazing(grazing, normal, row);
                tally[usize::from(grazed > 0.0) + usize::from(grazed >= 1.0)] += 1;
            }
            // Every part of the rule is among the cases.
            let between = if grazing == Grazing::Continuous { 50 } else { 0 };
            assert!(tally[0] > 500 && tally[1] >= between && tally[2] > 100, "{key:?} {grazing:?}: {tally:?}");
        }
    }
}

fn case(dice: &mut Dice, frame: &ShadowFrame) -> Case {
    let travel = Vec4::from_array(frame.uniforms.views[0].depth_from_render).truncate().normalize();
    let unit = dice.vector(1.0).normalize_or(Vec3::Y);
    let across = travel.cross(unit).normalize_or(Vec3::X);
    let normal = match dice.below(8) {
        0 => Vec3::ZERO,
        1 => unit,
        // Around every angle of the rule.
        _ => (across - travel * dice.single(-0.1, 0.2)).normalize(),
    };
    Case { position: dice.vector(5.0).extend(dice.single(0.0, 18.0)), normal: normal.extend(0.0) }
}
