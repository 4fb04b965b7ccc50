//! Shader functions against their Rust twins, on an adapter.
//!
//! Both sides round every operation, in an order that compilers may change, so two bounds hold:
//! - a lookup differs by the rounding of its own formula, propagated to first order ([`bound::LookupBound`]; for warped
//!   maps, operation by operation: [`rounded::Rounded`]);
//! - a comparison can tip over where depths are that close, and a texel change where coordinates are; the result then
//!   lies between the twin's values on both sides of the doubt. Samplers may keep 8 bits of the place between texels,
//!   rounded (as the twin does) or cut, or all of them: that changes a weight by at most 1/256 along each axis, and so
//!   any mean of taps by at most 2/256. (llvmpipe keeps all bits, half a step from the twin: it stays below 1/256.)

mod adapter;
mod bound;
mod cases;
mod check;
#[path = "../common/dice.rs"]
#[allow(dead_code, unreachable_pub, reason = "a part of it is used here")]
mod dice;
mod grazing;
mod many;
mod rounded;
#[path = "../support/mod.rs"]
mod support;

use antumbra::encoding::depth::{CompareMap, DepthMap};
use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::gpu::{Gpu, read_depth};
use antumbra::{Grazing, MapBudget, MapShape, ShadowFrame, Texel, ViewUniforms, WgslKey};
use bytemuck::{Pod, Zeroable};
use cases::{case, frame, noise};
use dice::Dice;
use glam::{UVec2, Vec2, Vec4};

/// Cases of each filter and map size.
const CASES: usize = 12_288;

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Case {
    view: ViewUniforms,
    position: Vec4,
    normal: Vec4,
    look: Vec4,
    slope_offset: Vec4,
    row: Vec4,
    weight: Vec4,
}

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Outcome {
    uv: Vec2,
    depth: f32,
    visible: f32,
    slope: Vec2,
    filtered: f32,
    visibility: f32,
    clip: Vec4,
    tap: f32,
    row: f32,
    lit: f32,
    caster_depth: f32,
}

#[test]
fn twins_agree() {
    let Some(gpu) = support::gpu() else { return };
    for key in WgslKey::all().filter(|key| key.maps == 1 && key.texel == Texel::Depth && key.grazing == Grazing::Off) {
        // A power of two, and sizes for which 1/size is not exact.
        for side in [64, 61, 7] {
            let worst = compare(&gpu, key, side);
            eprintln!("{key:?} ({side}², {CASES} cases, {}): {worst:?}", gpu.adapter());
        }
    }
}

/// The largest differences that were seen, for the record.
#[derive(Debug, Default)]
struct Worst {
    /// Share of the bound that lookups used.
    lookup: f64,
    /// Difference of a filtered value whose comparisons are beyond doubt.
    weight: f32,
    /// Cases in which a comparison was in doubt.
    doubtful: usize,
    /// Points of a warped map's receivers that lie behind its centre of projection, as both sides say.
    behind: usize,
    /// Points so near the plane through that centre that rounding decides where they go.
    undecided: usize,
    /// Penumbras so near that plane that rounding decides how wide they are.
    unspread: usize,
}

fn compare(gpu: &Gpu, key: WgslKey, side: u32) -> Worst {
    let filter = key.filter;
    // A map of noise, and frames that were fitted to it.
    let mut dice = Dice::new(0xA47A_B00C ^ (u64::from(side) << 8) ^ filter as u64);
    let frames: Vec<ShadowFrame> = (0..16).map(|index| frame(&mut dice, key, side, index)).collect();
    let depth: Vec<f32> = (0..side * side).map(|_| noise(&mut dice)).collect();
    let descriptor = ShadowMapsDescriptor { label: Some("twins"), key: frames[0].wgsl, map: MapBudget::one(side) };
    let maps = ShadowMaps::new(gpu.device(), &descriptor).unwrap();
    maps.prepare(gpu.queue(), &frames[0]).unwrap();
    adapter::fill(gpu, &maps, &frames[0].views[0], &depth);
    assert_eq!(read_depth(gpu, &maps, 0).unwrap(), depth, "the adapter stores depths as they are");
    // Run both.
    let cases: Vec<Case> = (0..CASES).map(|_| case(&mut dice, &frames, side, &depth)).collect();
    let outcomes = adapter::run(gpu, &maps, &cases);
    let map = DepthMap { size: UVec2::splat(side), depth: &depth };
    let mut worst = Worst::default();
    for (case, outcome) in cases.iter().zip(&outcomes) {
        check::lookup(key, case, outcome, &mut worst);
        check::caster(case, outcome);
        check::filters(key, &map, case, outcome, &mut worst);
        let (own, noise) = (&frames[0].uniforms.views[0], case.look.w);
        check::visible(key, &map, case, &case.view, noise, outcome.visible, &mut worst);
        check::visible(key, &map, case, own, noise, outcome.visibility, &mut worst);
        check::visible(key, &map, case, own, 0.0, outcome.lit, &mut worst);
    }
    // Bounds that doubt everything would prove nothing.
    assert!(worst.doubtful * 8 < 3 * CASES && worst.undecided * 8 < CASES && worst.unspread * 8 < CASES, "{worst:?}");
    assert!(key.shape == MapShape::Affine || worst.behind * 50 > CASES, "{worst:?}");
    worst
}

/// Hostile coordinates neither overflow nor panic, and finite ones give a share.
#[test]
fn the_twin_survives_anything() {
    let depth = [0.25, 0.5, 0.75, 1.0];
    let map = DepthMap { size: UVec2::splat(2), depth: &depth };
    for place in [1e30, -1e30, 1e10, -1e10, f32::MIN_POSITIVE, -0.0] {
        let value = map.sample_compare(Vec2::new(place, 0.5), 0.4);
        assert!((0.0..=1.0).contains(&value), "{place}: {value}");
    }
    for place in [f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        let _ = map.sample_compare(Vec2::new(place, place), 0.4);
    }
}
