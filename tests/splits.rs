//! What every split fit promises, over hostile inputs: slices cover the range, each receiver that something can shadow
//! finds a map with all that its filter reads, and what can shadow it is drawn there.

mod common;

use antumbra::encoding::depth::antumbra_look;
use antumbra::encoding::split::{antumbra_index, antumbra_room};
use antumbra::{
    Aabb, Camera, DepthSplits, Encoding, FitInput, Part, Pcf, Remix, Scheme, Select, ShadowFrame, ShadowTechnique,
    Share, Split, Stabilise, Warp, WgslKey, techniques,
};
use common::tally::Tally;
use common::{Inputs, caster, in_view, inputs, receiver, shares, sound_after};
use glam::{DVec3, UVec2, Vec3};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

fn scheme() -> impl Strategy<Value = Scheme> {
    let manual = prop::array::uniform7((-3.0..6.0_f32).prop_map(|log| 10.0_f32.powf(log))).prop_map(|mut depths| {
        depths.sort_by(f32::total_cmp);
        Scheme::Manual(depths)
    });
    prop_oneof![
        1 => Just(Scheme::Uniform),
        1 => Just(Scheme::Logarithmic),
        1 => (0.0..=1.0_f32, prop_oneof![Just(0.0), -100.0..100.0_f32])
            .prop_map(|(lambda, offset)| Scheme::Practical { lambda, offset }),
        3 => Just(Scheme::EqualError),
        1 => manual,
    ]
}

/// Hostile inputs, with few layers or enough, of odd sides as well; in every second case all around the camera, so that
/// there is much to split.
fn worlds() -> BoxedStrategy<Inputs> {
    let around = (inputs(), -1.0..5.0_f64).prop_map(|(inputs, log)| {
        let (eye, half) = (inputs.camera.world_from_view.w_axis.truncate(), 10.0_f64.powf(log));
        let bounds = Aabb::new(eye - half, eye + half);
        Inputs { casters: bounds, receivers: bounds, objects: Vec::new(), ..inputs }
    });
    (prop_oneof![inputs(), around], 1..=8_u32, 0..3_u32)
        .prop_map(|(inputs, layers, odd)| {
            let side = if odd == 0 { inputs.side.max(2) - 1 } else { inputs.side };
            Inputs { side, layers, ..inputs }
        })
        .boxed()
}

fn remixes() -> impl Strategy<Value = Remix> {
    let warp = prop::sample::select(vec![
        Warp::Uniform,
        Warp::Focused,
        Warp::Trapezoidal { focus: antumbra::Focus::default() },
        Warp::LightSpacePerspective,
        Warp::Perspective { pull_back: 0.0 },
        Warp::LeastError,
    ]);
    let blend = prop_oneof![2 => Just(0.0), 1 => Just(0.5), 1 => 0.0..0.5_f32];
    let enough = prop_oneof![2 => Just(0.0), 1 => Just(0.25), 1 => 0.0..16.0_f32];
    let splits = (1..=8_u8, scheme(), any::<bool>(), blend, any::<bool>(), enough).prop_map(
        |(maps, scheme, finest, blend, fade, enough)| {
            let select = if finest { Select::Finest } else { Select::Depth };
            DepthSplits { maps, scheme, select, blend, fade, enough }
        },
    );
    let share = prop::sample::select(vec![Share::Equal, Share::EqualError, Share::LeastError]);
    let filter = prop::sample::select(Pcf::ALL.to_vec());
    (warp, splits, any::<bool>(), share, filter).prop_map(|(warp, splits, snap, share, filter)| Remix {
        split: Split::Depth(splits),
        warp,
        share,
        encoding: Encoding::Depth(filter),
        stabilise: if snap { Stabilise::SnapTexels } else { Stabilise::Off },
        ..Remix::default()
    })
}

/// The views that a receiver is looked up in: by depth, one or two that are blended; by containment, the first that
/// holds it.
fn serving(key: WgslKey, frame: &ShadowFrame, at: Vec3, depth: f32) -> Vec<usize> {
    let used = frame.views.len();
    if key.maps == 1 {
        return vec![0];
    }
    let room = |index: usize| {
        let view = &frame.uniforms.views[index];
        antumbra_room(view, &antumbra_look(key, view, at, Vec3::ZERO))
    };
    if key.select == Select::Finest {
        return (0..used).find(|index| room(*index) >= 0.0).into_iter().collect();
    }
    let index = antumbra_index(&frame.uniforms, usize::from(key.maps) - 1, depth);
    let [.., from, per_depth] = frame.uniforms.views[index].domain;
    let share = ((depth - from) * per_depth).clamp(0.0, 1.0);
    let both = if key.blend && share > 0.0 { vec![index, index + 1] } else { vec![index] };
    both.into_iter().filter(|index| *index < used).collect()
}

/// A receiver's maps hold it, and draw its caster.
fn serves(
    frame: &ShadowFrame,
    remix: &Remix,
    inputs: &Inputs,
    receiver: DVec3,
    caster: DVec3,
) -> Result<(), TestCaseError> {
    let key = remix.wgsl_key();
    let at = (receiver - inputs.origin).as_vec3();
    let depth = -inputs.camera.world_from_view.inverse().transform_point3(receiver).z as f32;
    let maps = serving(key, frame, at, depth);
    let rooms: Vec<_> = (0..frame.views.len())
        .map(|i| {
            let v = &frame.uniforms.views[i];
            let l = antumbra_look(key, v, at, Vec3::ZERO);
            (v.domain, l, antumbra_room(v, &l))
        })
        .collect();
    prop_assert!(!maps.is_empty(), "no map at depth {depth} of {:?} {rooms:?}", frame.left_out);
    for index in maps {
        let view = &frame.views[index];
        let clip = view.clip_from_render * at.extend(1.0);
        let short = frame.left_out.iter().any(|cut| cut.part == Part::Border(index as u8));
        // All that the filter reads is drawn.
        let reach = if short { 0.0 } else { key.filter.reach() as f32 };
        let most = 1.0 - 2.0 * reach / view.viewport.z as f32;
        let out = clip.truncate().truncate().abs().max_element() / clip.w;
        prop_assert!(
            clip.w > 0.0 && out <= most,
            "view {index}: {out} of {most} at depth {depth} {:?} {rooms:?}",
            frame.left_out
        );
        // As it is compared: less what rounding may have added.
        let compared = antumbra_look(key, &frame.uniforms.views[index], at, Vec3::ZERO).depth;
        prop_assert!(compared <= 1.0, "view {index}: depth {compared}");
        // Found by depth, it is one of the receivers that the map was fitted to.
        let lies = view.depth_from_render.dot(at.extend(1.0));
        prop_assert!(lies >= 0.0 && (key.select == Select::Finest || lies <= 1.0), "view {index}: {lies}");
        prop_assert!(
            view.cull.may_cast(&Aabb::new(caster, caster)),
            "view {index} culls {caster} of {receiver} at {depth} {rooms:?} {:?} {:?}",
            view.cull.planes().iter().map(|p| p.dot((caster - inputs.origin).extend(1.0))).collect::<Vec<_>>(),
            frame.left_out
        );
        let first = view.depth_from_render.dot((caster - inputs.origin).as_vec3().extend(1.0));
        prop_assert!(first >= 0.0, "view {index} clips {caster}");
    }
    Ok(())
}

/// Maps lie inside their layers and not in each other, and have sides that are the layer's over powers of two.
fn tiles_are_apart(frame: &ShadowFrame, remix: &Remix, layers: u32) -> Result<(), TestCaseError> {
    let side = frame.map.side;
    let mut tiles: Vec<(u32, UVec2, u32)> = Vec::new();
    for (index, view) in frame.views.iter().enumerate() {
        let at = view.viewport;
        prop_assert_eq!(at.z, at.w);
        // One texel around it stays clear; the smallest maps have none.
        let ring = u32::from(side > 2);
        prop_assert!(at.x >= ring && at.y >= ring && view.layer < layers, "{at} of layer {}", view.layer);
        let (corner, length) = (UVec2::new(at.x, at.y) - ring, at.z + 2 * ring);
        prop_assert!((corner + length).max_element() <= side, "{corner} {length} of {side}");
        let halvings = (0..4).find(|halvings| side >> halvings == length);
        prop_assert!(halvings.is_some(), "{length} of {side}");
        let halved = frame.left_out.iter().any(|cut| cut.part == Part::Texels(index as u8));
        prop_assert_eq!(halved, halvings != Some(0));
        let short = frame.left_out.iter().any(|cut| cut.part == Part::Border(index as u8));
        prop_assert!(!(short && halved), "too small for its filter, and halved");
        prop_assert!(remix.share != Share::Equal || (!halved && view.layer == index as u32));
        prop_assert_eq!(frame.uniforms.views[index].across_u[3], view.layer as f32);
        for (layer, other, far) in &tiles {
            let apart = (corner + length).cmple(*other).any() || (*other + *far).cmple(corner).any();
            prop_assert!(*layer != view.layer || apart, "{corner} {length} and {other} {far} of layer {layer}");
        }
        tiles.push((view.layer, corner, length));
    }
    let area: u64 = tiles.iter().map(|(.., length)| u64::from(*length).pow(2)).sum();
    prop_assert!(area <= u64::from(layers) * u64::from(side).pow(2));
    Ok(())
}

/// Cases, those with a shadowed receiver in view, those of them with several views, with views that share layers; and
/// cases that a frame before changed.
static CASES: Tally<5> = Tally::new();

#[test]
fn nothing_is_lost_between_splits() {
    nothing_is_lost_over_hostile_inputs();
    let [cases, reached, several, packed, followed] = CASES.read();
    println!(
        "{cases} cases, {reached} with a shadowed receiver in view, {several} of them with several views, {packed} with \
         several in a layer; {followed} were changed by the frame before"
    );
    assert!(cases >= 100_000 && reached >= cases / 8 && several >= cases / 16 && packed >= cases / 200);
    assert!(followed >= cases / 200);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100_000, max_shrink_iters: 2_000, ..ProptestConfig::default() })]

    fn nothing_is_lost_over_hostile_inputs(
        inputs in worlds(),
        elsewhere in prop::option::of((worlds(), any::<bool>())),
        remix in prop_oneof![14 => remixes(), 1 => Just(techniques::smra()), 1 => Just(techniques::smra_plus())],
        shares in shares(),
        along in 0.0..=1.0_f64,
    ) {
        CASES.count(0);
        // After a frame of another world, or of this one through another lens, or the first one.
        let before = elsewhere.map(|(other, here)| {
            let camera = Camera { projection: other.camera.projection, ..inputs.camera };
            let before = if here { Inputs { camera, ..inputs.clone() } } else { Inputs { layers: inputs.layers, ..other } };
            remix.fit(&before.fit_input()).unwrap()
        });
        let frame = sound_after(remix, &inputs, before.as_ref())?;
        tiles_are_apart(&frame, &remix, inputs.layers)?;
        let fresh = remix.fit(&inputs.fit_input()).unwrap();
        if fresh.uniforms != frame.uniforms {
            CASES.count(4);
        }
        // A frame that follows itself keeps its planes: where maps do not share layers, every bit. Sizes may take one
        // frame more after a stranger: slices that got no map have none to remember.
        let again = remix.fit(&FitInput { previous: Some(&frame), ..inputs.fit_input() }).unwrap();
        tiles_are_apart(&again, &remix, inputs.layers)?;
        let sides = |frame: &ShadowFrame| frame.views.iter().map(|view| view.viewport.z).collect::<Vec<_>>();
        prop_assert!(before.is_some() || sides(&again) == sides(&frame));
        prop_assert!(remix.share != Share::Equal || again.uniforms == frame.uniforms);
        // Slices ascend, and leave no gap that is not accounted for.
        let domains = frame.uniforms.views[..frame.views.len()].iter().map(|view| view.domain);
        let planes: Vec<f32> = domains.flat_map(|domain| [domain[0], domain[1]]).collect();
        prop_assert!(frame.views.len() < 2 || planes.is_sorted(), "{planes:?}");
        if inputs.receivers.is_empty() || inputs.casters.is_empty() {
            return Ok(());
        }
        let receiver = receiver(&inputs, shares, along < 0.25);
        let Some(caster) = caster(&inputs, receiver, along) else { return Ok(()) };
        if !in_view(&inputs, receiver) {
            return Ok(());
        }
        CASES.count(1);
        if frame.views.len() > 1 {
            CASES.count(2);
        }
        if frame.views.iter().enumerate().any(|(index, view)| frame.views[..index].iter().any(|b| b.layer == view.layer)) {
            CASES.count(3);
        }
        serves(&frame, &remix, &inputs, receiver, caster)?;
    }
}
