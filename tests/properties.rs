//! What every fit promises, over hostile inputs: nothing that can be shadowed is outside its map, nothing that can
//! throw a shadow is culled, nothing is NaN, equal inputs give equal bits, snapped maps move by whole texels.

mod common;

use antumbra::{
    Aabb, Encoding, FitError, Light, MomentFormat, MomentKind, Moments, Prefilter, Remix, ShadowFrame, ShadowTechnique,
    Stabilise, techniques,
};
use common::tally::Tally;
use common::{Inputs, all_finite, caster, direction, in_view, inputs, receiver, shares, sound};
use glam::{DVec3, DVec4};
use proptest::prelude::*;

/// Remixes of one map that is not warped; `tests/splits.rs` and `tests/warps.rs` have the others.
fn remixes() -> impl Strategy<Value = Remix> {
    // Moments whose bleeding is reduced look at objects in pairs.
    let variance = Moments::new(MomentKind::Variance, MomentFormat::Float32);
    let encoding = Encoding::Moments(Prefilter { dark: 0.3, ..Prefilter::of(variance) });
    let moments = Remix { encoding, ..techniques::fsm() };
    let named = prop::sample::select(vec![techniques::ssm(), techniques::fsm(), moments]);
    (named, any::<bool>()).prop_map(|(remix, snap)| Remix {
        stabilise: if snap { Stabilise::SnapTexels } else { Stabilise::Off },
        ..remix
    })
}

/// These, and the composites by name.
fn with_composites() -> impl Strategy<Value = Remix> {
    prop_oneof![2 => remixes(), 1 => Just(techniques::smra()), 1 => Just(techniques::smra_plus())]
}

/// Clip coordinates through the narrowed matrix, of the position that a vertex buffer holds (f32, relative to origin).
fn clip(frame: &ShadowFrame, inputs: &Inputs, position: DVec3) -> glam::Vec4 {
    frame.views[0].clip_from_render * (position - inputs.origin).as_vec3().extend(1.0)
}

/// Cases of the main property, and those of them in which a receiver that something can shadow was in view.
static CASES: Tally<2> = Tally::new();

/// The main property; then, that its generator reaches what it is about in at least a sixth of the cases.
#[test]
fn nothing_is_lost() {
    nothing_is_lost_over_hostile_inputs();
    let [cases, reached] = CASES.read();
    println!("{reached} of {cases} cases had a shadowed receiver in view");
    assert!(cases >= 200_000 && reached >= cases / 6);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200_000, max_shrink_iters: 2_000, ..ProptestConfig::default() })]

    /// The main promise, over 200,000 inputs: receivers that a caster can shadow are inside the map with w > 0 and
    /// depth in [0, 1]; such casters pass the cull volume and are not clipped away; numbers are finite; bits are equal;
    /// no views means a reason; the orientation is kept.
    fn nothing_is_lost_over_hostile_inputs(inputs in inputs(), remix in remixes(), shares in shares(), along in 0.0..=1.0_f64) {
        CASES.count(0);
        let frame = sound(remix, &inputs)?;
        if inputs.receivers.is_empty() || inputs.casters.is_empty() {
            prop_assert!(frame.views.is_empty());
            return Ok(());
        }
        // A receiver in view that a caster can shadow, and that caster.
        // (in every fourth case: anywhere in the receivers' bounds).
        let receiver = receiver(&inputs, shares, along < 0.25);
        let seen = remix.warp == antumbra::Warp::Uniform || in_view(&inputs, receiver);
        let Some(caster) = caster(&inputs, receiver, along) else { return Ok(()) };
        if !seen {
            return Ok(());
        }
        CASES.count(1);
        prop_assert_eq!(frame.views.len(), 1, "{:?}", frame.left_out);
        let at = clip(&frame, &inputs, receiver);
        prop_assert_eq!(at.w, 1.0);
        prop_assert!(at.truncate().truncate().abs().max_element() <= 1.0, "receiver at {at}");
        prop_assert!((0.0..=1.0).contains(&at.z), "receiver at {at}");
        prop_assert!(frame.views[0].cull.may_cast(&Aabb::new(caster, caster)), "culled {caster}");
        let at = clip(&frame, &inputs, caster);
        prop_assert!(at.z >= 0.0, "the near plane cuts {caster} at {at}");
        // Clockwise stays clockwise.
        let matrix = frame.views[0].clip_from_render.as_dmat4();
        let across = matrix.row(0).truncate().cross(matrix.row(1).truncate());
        prop_assert!(across.dot(inputs.travel) < 0.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, ..ProptestConfig::default() })]

    /// Any NaN or infinity, anywhere, is an error or a legal frame: never a panic, never a NaN that comes out.
    #[test]
    fn broken_numbers_never_come_out(
        inputs in inputs(), remix in with_composites(), place in 0..24_usize,
        value in prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0, 1e300, -1e300, 1e-300, 5e-324]),
    ) {
        let mut input = inputs.fit_input();
        let travel = &mut inputs.travel.clone();
        match place {
            0..=2 => travel[place] = value,
            3..=5 => input.origin[place - 3] = value,
            6..=8 => input.scene.casters.min[place - 6] = value,
            9..=11 => input.scene.receivers.max[place - 9] = value,
            12..=14 => input.camera.world_from_view.w_axis[place - 12] = value,
            15..=17 => input.camera.world_from_view.x_axis[place - 15] = value,
            _ => if let antumbra::Projection::Perspective { left, right, down, up, near, far } = &mut input.camera.projection {
                *[left, right, down, up, near, far][place - 18] = value;
            },
        }
        input.light = Light::Directional { travel: *travel };
        if let Ok(frame) = remix.fit(&input) {
            prop_assert!(all_finite(&frame), "{frame:?}");
        }
    }

    /// Snapped maps: whatever the camera does, a fixed point of the world keeps its place among the texels.
    #[test]
    fn snapped_maps_move_by_whole_texels(
        travel in direction(), turn in direction(), step in direction(), log_step in -6.0..1.0_f64, far_out in 0.0..7.0_f64,
        fov in 20.0..120.0_f64, side in 6..13_u32, point in direction(),
    ) {
        let place = DVec3::new(0.3, 0.9, -0.2) * 10.0_f64.powf(far_out);
        let bounds = Aabb::new(place - 1e4, place + 1e4);
        let fit = |eye: DVec3, view: DVec3| {
            let rotation = glam::DQuat::from_rotation_arc(DVec3::NEG_Z, view);
            let camera = antumbra::Camera::perspective(
                glam::DMat4::from_rotation_translation(rotation, eye), fov.to_radians(), 1.5, 0.1, 100.0);
            let mut input = antumbra::FitInput {
                camera, light: Light::Directional { travel }, scene: antumbra::Scene::within(bounds),
                map: antumbra::MapBudget::one(1 << side), origin: eye, previous: None,
            };
            input.scene.visible_depth = None;
            let remix = Remix { stabilise: Stabilise::SnapTexels, ..techniques::fsm() };
            (remix.fit(&input).unwrap(), eye)
        };
        let (before, eye) = fit(place, turn);
        let moved = place + step * 10.0_f64.powf(log_step);
        let (after, moved) = fit(moved, (turn + step * 0.3).normalize_or(turn));
        // In f64 with the emitted f32 matrices: where a world point lands, in texels.
        let texels = |frame: &ShadowFrame, origin: DVec3| {
            let matrix = frame.views[0].clip_from_render.as_dmat4();
            let at = matrix * DVec4::from((place + point * 5.0 - origin, 1.0));
            at.truncate().truncate() * 0.5 * f64::from(frame.views[0].viewport.z)
        };
        let shift = texels(&before, eye) - texels(&after, moved);
        let off = (shift - shift.round()).abs().max_element();
        prop_assert!(off <= 1e-3, "{off} texels off the grid");
    }
}

/// A direction within a thousandth of unit length is normalised; others are refused by name.
#[test]
fn light_directions_are_normalised_or_refused() {
    let inputs = Inputs {
        camera: antumbra::Camera::perspective(glam::DMat4::IDENTITY, 1.0, 1.5, 0.1, 100.0),
        travel: DVec3::NEG_Y,
        casters: Aabb::new(DVec3::splat(-10.0), DVec3::splat(10.0)),
        receivers: Aabb::new(DVec3::splat(-10.0), DVec3::splat(10.0)),
        objects: Vec::new(),
        visible: None,
        points: Vec::new(),
        side: 1024,
        layers: 8,
        origin: DVec3::ZERO,
    };
    let fit = |scale: f64| {
        let mut input = inputs.fit_input();
        input.light = Light::Directional { travel: DVec3::new(0.6, -0.8, 0.0) * scale };
        techniques::fsm().fit(&input)
    };
    let exact = fit(1.0).unwrap();
    let near = fit(1.0009).unwrap();
    assert!(exact.views[0].clip_from_render.abs_diff_eq(near.views[0].clip_from_render, 1e-6));
    assert!(matches!(fit(1.01), Err(FitError::NotUnit { field: "light.travel", .. })));
    assert!(matches!(fit(0.0), Err(FitError::NotUnit { field: "light.travel", .. })));
}
