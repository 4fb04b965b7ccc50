//! Numbers with a bound of what f32 may have done to them: the lookup in warped maps, operation by operation.
//!
//! Compilers may reassociate sums and contract products, so that each operation counts two roundings, a division five
//! (WGSL promises 2.5 units in the last place), and a dot product that of all its terms.

use core::ops::{Add, Div, Mul, Neg, Sub};

use antumbra::{Pcf, ViewUniforms};
use glam::Vec3;

/// Half a step of f32 at 1.
pub(crate) const ULP: f64 = 0.5 * f32::EPSILON as f64;

/// A value, and by how much a result of f32 arithmetic may differ from that of other f32 arithmetic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounded {
    value: f64,
    error: f64,
}

impl Rounded {
    fn exact(value: impl Into<f64>) -> Self {
        Self { value: value.into(), error: 0.0 }
    }

    fn with(value: f64, propagated: f64, roundings: f64) -> Self {
        Self { value, error: propagated + roundings * ULP * value.abs() }
    }

    fn abs(self) -> Self {
        Self { value: self.value.abs(), ..self }
    }

    fn max(self, other: Self) -> Self {
        Self { value: self.value.max(other.value), error: self.error.max(other.error) }
    }

    fn min(self, other: Self) -> Self {
        -((-self).max(-other))
    }

    /// The same, where more than `most` of difference is impossible.
    fn at_most_off(self, most: f64) -> Self {
        Self { error: self.error.min(most), ..self }
    }
}

impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Add for Rounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let propagated = self.error + other.error;
        // Reassociated, a sum rounds its parts.
        let parts = 2.0 * ULP * (self.value.abs() + other.value.abs());
        Self { value: self.value + other.value, error: propagated + parts }
    }
}

impl Sub for Rounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Rounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let propagated = self.value.abs() * other.error + other.value.abs() * self.error + self.error * other.error;
        Self::with(self.value * other.value, propagated, 2.0)
    }
}

impl Div for Rounded {
    type Output = Self;
    fn div(self, by: Self) -> Self {
        let value = self.value / by.value;
        // Nothing is known of a quotient by what may be zero.
        let least = (by.value.abs() - by.error).max(0.0);
        Self::with(value, (self.error + value.abs() * by.error) / least, 5.0)
    }
}

/// Of four terms: seven operations.
fn dot(row: [f32; 4], at: [Rounded; 4]) -> Rounded {
    let terms = || row.iter().zip(at).map(|(factor, at)| (f64::from(*factor), at));
    let value = terms().map(|(factor, at)| factor * at.value).sum();
    let error = terms().map(|(factor, at)| factor.abs() * (at.error + 14.0 * ULP * at.value.abs())).sum();
    Rounded { value, error }
}

/// The receiver, moved by a manual bias.
fn moved(view: &ViewUniforms, position: Vec3, normal: Vec3) -> [Rounded; 4] {
    let manual = Rounded::exact(view.bias[1]);
    let axis = |axis: usize| Rounded::exact(position[axis]) + Rounded::exact(normal[axis]) * manual;
    [axis(0), axis(1), axis(2), Rounded::exact(1.0)]
}

/// Whether a point is behind the centre of projection beyond doubt.
pub(crate) fn behind(view: &ViewUniforms, position: Vec3, normal: Vec3) -> bool {
    let w = dot(view.w_from_render, moved(view, position, normal));
    w.value < -w.error
}

/// Bounds of u, v, depth, and slope in u and in v of `antumbra_lookup_projective`; `None` where w may or may not be
/// positive.
pub(crate) fn lookup_projective(view: &ViewUniforms, position: Vec3, normal: Vec3, filter: Pcf) -> Option<[f64; 5]> {
    let exact = |value: f32| Rounded::exact(value);
    let one = Rounded::exact(1.0);
    let (reach, tap_reach) = (Rounded::exact(filter.reach()), Rounded::exact(filter.tap_reach()));
    let [_, _, depth_squared, grazing] = view.texel.map(exact);
    let [lost_reach, _, growth, texel] = view.bias.map(exact);
    // Where it is.
    let at = moved(view, position, normal);
    let w = dot(view.w_from_render, at);
    if w.value.abs() <= 2.0 * w.error {
        return None;
    }
    let inside = w.value > 0.0;
    let from_w = if inside { one / w } else { Rounded::exact(0.0) };
    let [u, v] = [view.u_from_render, view.v_from_render].map(|row| dot(row, at) * from_w);
    // How far its plane falls.
    let along = normal.extend(0.0).to_array().map(exact);
    let [across_u, across_v, shared] = [view.across_u, view.across_v, view.across_w].map(|row| dot(row, along));
    let fall = [across_v - v * shared, u * shared - across_u].map(|fall| w * w * fall);
    let step = fall[0].abs() + fall[1].abs();
    // Its slope to the light.
    let cosine = -dot(view.depth_from_render, along);
    let inverse = one / cosine.abs().max(grazing);
    let across = one - cosine.abs() * inverse;
    let wide = reach + lost_reach;
    let largest = fall[0].abs().max(fall[1].abs()).max(Rounded::exact(1e-37));
    // Shares of the larger of two numbers.
    let up = fall.map(|fall| (fall / largest).at_most_off(2.0));
    let squares = (up[0] * up[0] + up[1] * up[1]).max(one);
    let along_fall = wide * across * (up[0].abs() + up[1].abs()) / squares;
    let most = 2.0 * 1.21 * wide.value * (across.value.abs() + across.error);
    let shift = up.map(|up| (up * along_fall).at_most_off(most));
    let growth = (wide * (one + across * exact(1.2072)) * growth * w.abs()).min(exact(0.5));
    // The lift; its sign is in doubt where the cosine's is.
    let flips = if cosine.value.abs() <= cosine.error { 2.0 } else { 0.0 };
    let size = depth_squared * inverse;
    let size = Rounded { value: size.value, error: size.error + flips * size.value };
    let depth_per_fall = if cosine.value >= 0.0 { size } else { -size };
    let lift = (tap_reach + lost_reach + reach * growth) / (one - growth) * step * depth_per_fall;
    let depth = if inside { dot(view.depth_from_render, at) - lift } else { Rounded::exact(0.0) };
    let [u, v] = [u + shift[0] * texel, v + shift[1] * texel];
    Some([u, v, depth, fall[0] * depth_per_fall, fall[1] * depth_per_fall].map(|number| number.error))
}
