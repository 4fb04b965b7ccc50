//! Over hostile inputs: footprints are what neighbouring rays see, and no larger or smaller than a fit predicts.

use antumbra::aliasing::{PointFootprint, footprint_at, perspective_at};
use antumbra::warp::Warp;
use antumbra::{Remix, ShadowFrame, ShadowTechnique, ViewUniforms, techniques};
use glam::{DVec2, DVec3, Vec4};
use proptest::prelude::*;

use crate::common::tally::Tally;
use crate::common::{Inputs, direction, in_view, inputs, view_point};
use crate::sight::{Sight, differences, doubt, pixel_size, singular};

/// The named techniques of one map as they come, as published, and warps of every strength.
fn remixes() -> impl Strategy<Value = Remix> {
    let one = techniques::NAMED.iter().filter(|(_, technique)| technique().split == antumbra::Split::One);
    let named = (prop::sample::select(one.collect::<Vec<_>>()), any::<bool>());
    prop_oneof![
        3 => named.prop_map(|((_, technique), guard)| Remix { guard, ..technique() }),
        1 => (-2.0..3.0_f32).prop_map(|log| Remix { warp: Warp::Fixed { strength: 10.0_f32.powf(log) }, ..Remix::default() }),
    ]
}

/// The composites as well, whose maps each have a footprint.
fn with_composites() -> impl Strategy<Value = Remix> {
    prop_oneof![8 => remixes(), 1 => Just(techniques::smra()), 1 => Just(techniques::smra_plus())]
}

fn shares() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.0..=1.0_f64)
}

fn fit(inputs: &Inputs, remix: &Remix) -> Option<ShadowFrame> {
    remix.fit(&inputs.fit_input()).ok().filter(|frame| !frame.views.is_empty())
}

fn at(view: &ViewUniforms, inputs: &Inputs, position: DVec3, normal: DVec3) -> Option<PointFootprint> {
    footprint_at(view, inputs.side, &inputs.camera, inputs.origin, position, normal)
}

/// Cases, those with a footprint, those of a warped map, those in which J is known to the last of the digits asked for,
/// and the last map of several that had one.
static REACHED: Tally<5> = Tally::new();

#[test]
fn footprints_are_what_neighbouring_rays_see() {
    over_hostile_frames();
    let [cases, found, warped, sharp, last] = REACHED.read();
    println!("{cases} cases, {found} with a footprint, {warped} of them warped, {sharp} compared to 1e-6");
    assert!(found * 5 > cases && warped * 10 > found && sharp * 3 > found, "{cases} {found} {warped} {sharp}");
    assert!(last > 0, "no map but the first one");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40_000, max_shrink_iters: 500, ..ProptestConfig::default() })]

    fn over_hostile_frames(inputs in inputs(), remix in with_composites(), which in any::<prop::sample::Index>(), shares in shares(), free in direction(), on_axis in any::<bool>()) {
        REACHED.count(0);
        let inputs = Inputs { casters: inputs.receivers, ..inputs };
        let Some(frame) = fit(&inputs, &remix) else { return Ok(()) };
        let seen = view_point(&inputs.camera, shares).clamp(inputs.receivers.min, inputs.receivers.max);
        let position = seen - inputs.origin;
        // Often a floor or a wall, else anything.
        let normal = if on_axis { DVec3::Y } else { free };
        let which = which.index(frame.views.len());
        let view = &frame.uniforms.views[which];
        let Some(found) = at(view, &inputs, position, normal) else { return Ok(()) };
        REACHED.count(1);
        REACHED.raise(4, which as u32);
        let sight = Sight::new(&inputs.camera, inputs.origin, position, normal);
        let Some(columns) = differences(view, inputs.side, &inputs.camera, position, &sight) else { return Ok(()) };
        let (least, most, determinant) = singular(columns);
        if view.w_from_render[..3] != [0.0; 3] {
            REACHED.count(2);
        }
        // Differences know J to nine digits of its largest entry; far from the origin, both know the map less well.
        let pixel = [DVec2::X, DVec2::Y].map(|axis| sight.meet(axis * 1e-6).length() * 1e6).into_iter().fold(0.0, f64::max);
        let noise = 1e-9 * most + doubt(view, inputs.side, position) * pixel * pixel_size(&inputs.camera).max_element();
        if noise < 1e-6 * least {
            REACHED.count(3);
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b;
            prop_assert!(close(found.texels_per_pixel, least), "{} is {}", found.texels_per_pixel, least);
            prop_assert!(close(found.pixels_per_texel, 1.0 / least), "{} is {}", found.pixels_per_texel, 1.0 / least);
            prop_assert!(close(found.perspective * found.projection, found.pixels_per_texel));
            prop_assert!(close(found.area, 1.0 / determinant), "{} is {}", found.area, 1.0 / determinant);
        }
        prop_assert!((found.texels_per_pixel - least).abs() <= 1e-6 * least + noise, "{} is {} of {}", found.texels_per_pixel, least, most);
    }
}

/// Points in view; by how many millionths the perspective part lies above the predicted range in warped maps, and by
/// what per cent of it below.
static PREDICTED: Tally<3> = Tally::new();

/// A texel's side is predicted at the corners of what is in view, its longest extent measured anywhere: a
/// parallelogram's is at most √2 of its longest side, and the error W²/ζ of a warped map is least somewhere in between.
/// Of one map: what several predict, they predict for what each of them is fitted to, not for what it happens to serve.
#[test]
fn predicted_extremes_hold() {
    predicted_extremes_hold_over_hostile_frames();
    let [points, above, below] = PREDICTED.read();
    println!("{points} points; warped maps: at most {above} millionths above the prediction, {below} % below it");
    assert!(points > 10_000);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40_000, max_shrink_iters: 500, ..ProptestConfig::default() })]

    fn predicted_extremes_hold_over_hostile_frames(inputs in inputs(), remix in remixes(), shares in shares()) {
        // What nothing can shadow is not in the body: here everything casts.
        let inputs = Inputs { casters: inputs.receivers, ..inputs };
        let Some(frame) = fit(&inputs, &remix) else { return Ok(()) };
        let point = view_point(&inputs.camera, shares).clamp(inputs.receivers.min, inputs.receivers.max);
        if !in_view(&inputs, point) {
            return Ok(());
        }
        let view = &frame.uniforms.views[0];
        let Some(found) = perspective_at(view, inputs.side, &inputs.camera, inputs.origin, point - inputs.origin) else { return Ok(()) };
        // Where a body is a speck far from the origin, w is as good as positions in f32, and not as predicted.
        let (w, at) = (Vec4::from(view.w_from_render).as_dvec4(), point - inputs.origin);
        if w.truncate().length() * at.length() * f64::from(f32::EPSILON) > 1e-3 * w.dot(at.extend(1.0)) {
            return Ok(());
        }
        let (least, most) = (f64::from(frame.predicted.min), f64::from(frame.predicted.max));
        PREDICTED.count(0);
        let warped = view.w_from_render[..3] != [0.0; 3];
        // Rows are rounded to f32.
        let (below, above) = if warped { (0.0, std::f64::consts::SQRT_2 * 1.05) } else { (0.9999, 1.0001) };
        if warped && most > 0.0 {
            PREDICTED.raise(1, ((found / most - 1.0).max(0.0) * 1e6) as u32);
            PREDICTED.raise(2, ((1.0 - found / least).max(0.0) * 1e2) as u32);
        }
        prop_assert!(found >= least * below && found <= most * above, "{} is outside {} to {}", found, least, most);
    }
}
