//! How far a shader's lookup may be from its twin.

use antumbra::encoding::depth::{Lookup, antumbra_lookup, antumbra_lookup_projective};
use antumbra::encoding::pixel::{Pixel, antumbra_spread_pixel};
use antumbra::encoding::spread::Spread;
use antumbra::{MapShape, Pcf, ViewUniforms, WgslKey};
use glam::{Vec3, Vec4};

use crate::rounded::{self, ULP};

/// First-order rounding of `antumbra_lookup`, each operation within two steps and divisions within five.
pub(crate) struct LookupBound {
    pub(crate) uv: [f64; 2],
    pub(crate) depth: f64,
    pub(crate) slope: [f64; 2],
}

/// The lookup of a key, and how far the shader's may be from it; `None` where rounding decides about everything.
pub(crate) fn lookup(key: WgslKey, view: &ViewUniforms, position: Vec3, normal: Vec3) -> Option<(Lookup, LookupBound)> {
    let (reach, tap_reach) = (key.filter.reach() as f32, key.filter.tap_reach() as f32);
    match key.shape {
        MapShape::Affine => {
            let twin = antumbra_lookup(view, position, normal, reach, tap_reach);
            Some((twin, LookupBound::of(key.filter, view, position, normal)))
        }
        shape => {
            let twin = antumbra_lookup_projective(shape, view, position, normal, reach, tap_reach);
            let [uv_x, uv_y, depth, slope_x, slope_y] = rounded::lookup_projective(view, position, normal, key.filter)?;
            let mut bound = LookupBound { uv: [uv_x, uv_y], depth, slope: [slope_x, slope_y] };
            if shape == MapShape::ProjectiveDepth {
                bound.divide(view, position, normal, &twin);
            }
            Some((twin, bound))
        }
    }
}

impl LookupBound {
    /// What dividing by w adds: the bounds shrink by the law, which is itself as exact as w and the growth are.
    fn divide(&mut self, view: &ViewUniforms, position: Vec3, normal: Vec3, twin: &Lookup) {
        let at = (position + normal * view.bias[1]).extend(1.0);
        let row = Vec4::from_array(view.w_from_render);
        let w = f64::from(row.dot(at));
        let size = f64::from(row.abs().dot(at.abs()));
        // Growth is at most a half, so that its rounding counts twice; the rest is products.
        let share = 24.0 * ULP * (size / w.abs() + 2.0);
        let law = if w > 0.0 { 1.0 / w } else { 1.0 };
        self.depth = self.depth * law + f64::from(twin.depth.abs()) * share;
        for (bound, slope) in self.slope.iter_mut().zip(twin.slope.to_array()) {
            *bound = *bound * law + f64::from(slope.abs()) * share;
        }
    }

    fn of(filter: Pcf, view: &ViewUniforms, position: Vec3, normal: Vec3) -> Self {
        // A dot product of four terms: seven operations.
        let dot_error = 14.0 * ULP;
        let magnitude = |row: [f32; 4], at: [f64; 3], last: f64| -> f64 {
            let spatial: f64 = (0..3).map(|axis| (f64::from(row[axis]) * at[axis]).abs()).sum();
            spatial + (f64::from(row[3]) * last).abs()
        };
        let n = normal.to_array().map(f64::from);
        let p = position.to_array().map(f64::from);
        let [lost, manual, ..] = view.bias.map(f64::from);
        let [fall_u, fall_v, depth_squared, grazing] = view.texel.map(f64::from);
        // The climb, the fall, its sum, and the cosine.
        let climb = [view.u_from_render, view.v_from_render].map(|row| magnitude(row, n, 0.0));
        let climb_error = climb.map(|size| size * dot_error);
        let fall = [climb[0] * fall_u, climb[1] * fall_v];
        let fall_error = fall.map(|size| size * (dot_error + 2.0 * ULP));
        let (step, step_error) = (fall[0] + fall[1], fall_error[0] + fall_error[1] + (fall[0] + fall[1]) * 2.0 * ULP);
        let cosine = magnitude(view.depth_from_render, n, 0.0);
        let cosine_error = cosine * dot_error;
        let inverse = 1.0 / grazing.max(f64::from(f32::MIN_POSITIVE));
        let inverse_error = inverse * inverse * cosine_error + 5.0 * ULP * inverse;
        // The lift along the normal: it moves the place, and the depth.
        let share_error = inverse * cosine_error + inverse_error * grazing + 6.0 * ULP;
        let reach = filter.reach() + lost;
        let along = reach * step + manual.abs();
        let along_error = reach * (step_error + step * share_error) + 8.0 * ULP * along;
        let row = |row: [f32; 4]| magnitude(row, p, 1.0) * dot_error;
        let moved =
            |size: f64, error: f64, by: f64, by_error: f64| size * by_error + error * by + 4.0 * ULP * size * by;
        let uv = |axis: usize, row_error: f64, whole: f64| {
            row_error
                + moved(climb[axis], climb_error[axis], along, along_error)
                + 2.0 * ULP * (whole + climb[axis] * along)
        };
        // The lift along the light; its sign is in doubt where the cosine's is.
        let exact: f64 = (0..3).map(|axis| f64::from(view.depth_from_render[axis]) * n[axis]).sum();
        let flips = if exact.abs() <= cosine_error { 2.0 } else { 0.0 };
        let fall_depth = depth_squared * inverse;
        let fall_depth_error = depth_squared * (inverse_error + 2.0 * ULP * inverse);
        let tap_reach = filter.tap_reach() + lost;
        let tap = tap_reach * (step_error * fall_depth + step * (fall_depth_error + (flips + 6.0 * ULP) * fall_depth));
        let sum = magnitude(view.depth_from_render, p, 1.0) + cosine * along + tap_reach * step * fall_depth;
        Self {
            uv: [
                uv(0, row(view.u_from_render), magnitude(view.u_from_render, p, 1.0)),
                uv(1, row(view.v_from_render), magnitude(view.v_from_render, p, 1.0)),
            ],
            depth: row(view.depth_from_render)
                + moved(cosine, cosine_error, along, along_error)
                + tap
                + 6.0 * ULP * sum,
            slope: core::array::from_fn(|axis| {
                fall_error[axis] * fall_depth + fall[axis] * (fall_depth_error + (flips + 2.0 * ULP) * fall_depth)
            }),
        }
    }
}

/// By how much of itself the spread of a penumbra's taps may be off: by what the derivative of texture coordinates
/// loses where rows and w cancel.
pub(crate) fn spread(view: &ViewUniforms, position: Vec3) -> f64 {
    let at = position.extend(1.0).as_dvec4();
    let row = |row: [f32; 4]| Vec4::from_array(row).as_dvec4();
    let rows = [view.u_from_render, view.v_from_render].map(row);
    let by = row(view.w_from_render);
    let w = by.dot(at);
    let off_w = by.abs().dot(at.abs()) / w.abs();
    // What a row less a coordinate times w loses, over the smallest of the two gradients.
    let lost = rows.map(|row| {
        let coordinate = row.dot(at) / w;
        let off = row.abs().dot(at.abs()) / w.abs() + coordinate.abs() * off_w;
        let gradient = (row - by * coordinate).truncate().length();
        (row.truncate().length() + by.truncate().length() * (coordinate.abs() + 4.0 * off)) / gradient
    });
    let lost = lost[0].max(lost[1]);
    // A view without any texels has no taps to be off.
    if lost.is_finite() { 16.0 * ULP * (lost + off_w + 1.0) } else { 0.0 }
}

/// By how much taps over a pixel may be off beside the lookup itself, texture coordinates and depth: what nudging the
/// receiver and its normal by a few steps of f32 does to them. `None` where rounding decides about everything.
pub(crate) fn pixel(view: &ViewUniforms, position: Vec3, normal: Vec3, look: &Lookup) -> Option<([f64; 2], f64)> {
    let places = |spread: &Spread| {
        let Pixel { first, second, lift, .. } = spread.pixel;
        [(first, lift.x), (-first, lift.x), (second, lift.y), (-second, lift.y)].map(|(step, lift)| {
            let [before, w] = [spread.w, spread.w + step.z].map(f64::from);
            let [law_before, law] = match spread.shape {
                MapShape::ProjectiveDepth => [before, w],
                MapShape::Affine | MapShape::Projective => [1.0, 1.0],
            };
            if w <= 0.5 * before {
                return [f64::from(look.uv.x), f64::from(look.uv.y), f64::from(look.depth)]
                    .map(|place| place.clamp(-1.0, 2.0));
            }
            let uv = (look.uv.as_dvec2() * before + step.truncate().truncate().as_dvec2()) / w;
            let depth = (f64::from(look.depth) * law_before + f64::from(step.w) - f64::from(lift)) / law;
            // What lies beyond the map is not read, wherever it is.
            [uv.x, uv.y, depth].map(|place| place.clamp(-1.0, 2.0))
        })
    };
    let spread = |position, normal| antumbra_spread_pixel(look.spread.shape, view, position, normal);
    let exact = places(&spread(position, normal));
    let size = position.abs().max(Vec4::from_array(view.moments).truncate().abs()).max_element();
    let mut off = [0.0_f64; 3];
    for axis in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
        let nudge = axis * (NUDGE * ULP) as f32;
        // Receivers without a normal have none in the shader either.
        let nudged = if normal == Vec3::ZERO { normal } else { normal + nudge };
        for moved in [spread(position + nudge * size, normal), spread(position, nudged)] {
            for (place, exact) in places(&moved).iter().zip(&exact) {
                for (off, (place, exact)) in off.iter_mut().zip(place.iter().zip(exact)) {
                    *off = off.max((place - exact).abs() + 8.0 * ULP * exact.abs());
                }
            }
        }
    }
    let texel = f64::from(view.bias[3]);
    let decided = off.iter().all(|off| off.is_finite()) && (texel == 0.0 || off[0].max(off[1]) <= 0.25 * texel);
    decided.then_some(([off[0], off[1]], off[2]))
}

/// Steps of f32 that a receiver is nudged by: as many operations as there are on the way to its taps.
const NUDGE: f64 = 24.0;
