//! What every warped fit promises, over hostile inputs: what can be shadowed is inside the map with W > 0, what can
//! throw a shadow is neither culled nor clipped, one light ray is one point of the map, depth grows along it, the
//! winding of the world is kept, nothing is NaN, equal inputs give equal bits;
//! and guarded warps are never predicted to be worse than none.

mod common;

use antumbra::{Aabb, Focus, Remix, ShadowFrame, Warp};
use common::tally::Tally;
use common::{Inputs, caster, in_view, inputs, receiver, shares, sound};
use glam::{DVec3, DVec4};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

/// Inputs that each warp is tried on.
const CASES: u32 = 200_000;

/// Every warp that bends, with options at random, and whether it is guarded.
/// Guards leave fixed strengths and least-error alone.
fn remixes([strength, focus, pull_back]: [f32; 3]) -> [Remix; 12] {
    let warped = |warp, guard| Remix { warp, guard, ..Remix::default() };
    let focused = |focus| Warp::Trapezoidal { focus };
    [
        warped(Warp::Fixed { strength: 0.0 }, false),
        warped(Warp::Fixed { strength }, false),
        warped(Warp::LeastError, true),
        warped(focused(Focus::Share(focus)), true),
        warped(focused(Focus::Share(focus)), false),
        warped(focused(Focus::Distance(pull_back)), false),
        warped(Warp::LightSpacePerspective, true),
        warped(Warp::LightSpacePerspective, false),
        warped(Warp::Perspective { pull_back }, true),
        warped(Warp::Perspective { pull_back }, false),
        warped(Warp::Minimax, true),
        warped(Warp::Minimax, false),
    ]
}

/// Strength, focus and pull-back: zero, the least, the most, and everything between.
fn options() -> impl Strategy<Value = [f32; 3]> {
    let strength = prop_oneof![1 => Just(0.0), 1 => Just(1e3), 6 => (-6.0..3.0_f32).prop_map(|log| 10.0_f32.powf(log))];
    let focus = prop_oneof![1 => Just(0.0), 1 => Just(1.0), 2 => Just(0.3), 4 => 0.0..1.0_f32];
    let pull_back =
        prop_oneof![2 => Just(0.0), 1 => Just(1e15), 4 => (-4.0..6.0_f32).prop_map(|log| 10.0_f32.powf(log))];
    (strength, focus, pull_back).prop_map(|(strength, focus, pull_back)| [strength, focus, pull_back])
}

/// A receiver in view, and a caster that shadows it.
struct Pair {
    receiver: DVec3,
    caster: DVec3,
}

/// The receiver at some shares of the view (or, if `anywhere`, of the receivers' bounds) and a caster at a share of its
/// ray to the light, if there are such.
fn pair(inputs: &Inputs, shares: [f64; 3], along: f64, anywhere: bool) -> Option<Pair> {
    if inputs.receivers.is_empty() {
        return None;
    }
    let receiver = receiver(inputs, shares, anywhere);
    if !in_view(inputs, receiver) {
        return None;
    }
    Some(Pair { receiver, caster: caster(inputs, receiver, along)? })
}

/// A receiver is on the map, its caster is drawn, and the map keeps the sense of rotation where the receiver is.
fn serves(frame: &ShadowFrame, remix: Remix, inputs: &Inputs, pair: &Pair) -> Result<(), TestCaseError> {
    let name = || format!("{:?} guard {}", remix.warp, remix.guard);
    prop_assert_eq!(frame.views.len(), 1, "{}: {:?}", name(), frame.left_out);
    let view = &frame.views[0];
    // As a vertex buffer holds it: f32, relative to the origin.
    let clip = |at: DVec3| view.clip_from_render * (at - inputs.origin).as_vec3().extend(1.0);
    let depth = |at: DVec3| view.depth_from_render.dot((at - inputs.origin).as_vec3().extend(1.0));
    let at = clip(pair.receiver);
    prop_assert!(at.w >= 0.5, "{}: receiver at {at}", name());
    prop_assert!(at.truncate().truncate().abs().max_element() <= at.w, "{}: receiver at {at}", name());
    let lies = depth(pair.receiver);
    prop_assert!((0.0..=1.0).contains(&lies), "{}: receiver at {lies}", name());
    // Its caster.
    prop_assert!(view.cull.may_cast(&Aabb::new(pair.caster, pair.caster)), "{}: culled {}", name(), pair.caster);
    let lies = depth(pair.caster);
    prop_assert!(lies >= 0.0, "{}: the near plane cuts {} at {lies}", name(), pair.caster);
    let at = clip(pair.caster);
    prop_assert!(at.w > 0.0, "{}: caster at {at}", name());
    // Rows x, y and w over two axes across the light and the receiver itself: seen along the light.
    let rows = [0, 1, 3].map(|row| view.clip_from_render.row(row).as_dvec4());
    let across = inputs.travel.any_orthonormal_vector();
    let up = across.cross(inputs.travel);
    let here = DVec4::from((pair.receiver - inputs.origin, 1.0));
    let [x, y, w] = rows.map(|row| DVec3::new(row.truncate().dot(across), row.truncate().dot(up), row.dot(here)));
    prop_assert!(x.cross(y).dot(w) > 0.0, "{}: mirrored", name());
    // One light ray is one point of the map: as far as f32 can say, the rows of x, y and w do not change along it.
    for row in [0, 1, 3].map(|row| view.clip_from_render.row(row).truncate().as_dvec3()) {
        let narrowed = 2.0 * f64::from(f32::EPSILON) * row.abs().dot(inputs.travel.abs());
        let rounding = narrowed + 8.0 * f64::EPSILON * row.length() + f64::from(f32::MIN_POSITIVE);
        prop_assert!(row.dot(inputs.travel).abs() <= rounding, "{}: bends light", name());
    }
    // Depth grows along it.
    let row = view.depth_from_render.as_dvec4();
    prop_assert!(row.truncate().dot(inputs.travel) > 0.0, "{}: depth falls", name());
    let from_origin = [pair.caster, pair.receiver].map(|at| DVec4::from((at - inputs.origin, 1.0)));
    let [first, last] = from_origin.map(|at| row.dot(at));
    let rounding =
        4.0 * f64::from(f32::EPSILON) * from_origin.map(|at| row.abs().dot(at.abs())).into_iter().sum::<f64>();
    prop_assert!(last - first <= rounding || depth(pair.caster) < depth(pair.receiver), "{}: out of order", name());
    Ok(())
}

/// Cases, and those of them in which a receiver that something can shadow was in view.
static COUNTS: Tally<2> = Tally::new();

/// The main property; then, that its generator reaches what it is about in at least a sixth of the cases.
#[test]
fn nothing_is_lost() {
    nothing_is_lost_over_hostile_inputs();
    let [cases, reached] = COUNTS.read();
    println!("{reached} of {cases} cases had a shadowed receiver in view; 12 warps each");
    assert!(cases >= CASES && reached >= cases / 6);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: CASES, max_shrink_iters: 4_000, ..ProptestConfig::default() })]

    fn nothing_is_lost_over_hostile_inputs(
        inputs in inputs(), options in options(), receivers in prop::array::uniform4(shares()), along in 0.0..=1.0_f64,
    ) {
        COUNTS.count(0);
        let pairs = receivers.into_iter().enumerate();
        let pairs: Vec<Pair> = pairs.filter_map(|(index, at)| pair(&inputs, at, along, index == 3)).collect();
        if !pairs.is_empty() {
            COUNTS.count(1);
        }
        let [uniform, warps @ ..] = remixes(options);
        let uniform = sound(uniform, &inputs)?;
        for remix in warps {
            let frame = sound(remix, &inputs)?;
            for pair in &pairs {
                serves(&frame, remix, &inputs, pair)?;
            }
            if remix.guard && !uniform.views.is_empty() {
                let (ours, none) = (frame.predicted.error, uniform.predicted.error);
                prop_assert!(ours <= none * 1.0001, "{:?}: predicted {ours}, without {none}", remix.warp);
            }
        }
    }
}
