//! The pencil of a light: coordinates in which each of its rays is a point.
//!
//! # References
//! - `MATH.md` section 0 (light space and homography) and section 2 (side vectors).
//! - Brauer's theorem on the hairy ball: no choice of axes across a direction is continuous over all directions. The
//!   fixed frame pays with one point, light that travels along +y exactly.

use glam::{DMat3, DMat4, DVec2, DVec3};

use crate::math::space::{Map, Ray, Render};

/// Orthonormal coordinates (p, q, r) of render space: r along the travel of light, p and q across.
/// Seen along the light, p points right and q up: `p × q = −r`, as in clip space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightSpace {
    p: DVec3,
    q: DVec3,
    travel: DVec3,
}

impl LightSpace {
    /// The frame that depends on the light alone: the least rotation that takes (x, −z, −y) to it.
    ///
    /// Continuous, with a bounded derivative away from its pole, light travelling along +y; there it is still a frame.
    pub(crate) fn fixed(travel: DVec3) -> Self {
        // With d = −travel, the least rotation from +y to d, written out (Duff et al. 2017, JCGT 6(1), equation 3, axes
        // permuted): its denominator vanishes only at d = −y.
        let d = -travel;
        let denominator = 1.0 + d.y;
        if denominator < POLE {
            return Self { p: DVec3::X, q: DVec3::X.cross(travel), travel }.orthonormal();
        }
        let shared = -d.x * d.z / denominator;
        let p = DVec3::new(1.0 - d.x * d.x / denominator, -d.x, shared);
        Self { p, q: p.cross(travel), travel }.orthonormal()
    }

    /// The frame turned so that p points along `axis`, given in its own (p, q).
    pub(crate) fn turned(self, axis: DVec2) -> Self {
        let p = self.p * axis.x + self.q * axis.y;
        Self { p, q: p.cross(self.travel), travel: self.travel }.orthonormal()
    }

    /// Removes what rounding has added: p across the light exactly enough, q from both.
    fn orthonormal(self) -> Self {
        let p = (self.p - self.travel * self.travel.dot(self.p)).normalize();
        Self { p, q: p.cross(self.travel), travel: self.travel }
    }

    /// Ray coordinates of a render-space position or direction.
    pub(crate) fn ray(&self, position: DVec3) -> DVec3 {
        DVec3::new(self.p.dot(position), self.q.dot(position), self.travel.dot(position))
    }

    /// The unit axis p, render space.
    pub(crate) fn p(&self) -> DVec3 {
        self.p
    }

    /// The unit axis q, render space.
    pub(crate) fn q(&self) -> DVec3 {
        self.q
    }

    /// The travel of light, unit length.
    pub(crate) fn travel(&self) -> DVec3 {
        self.travel
    }

    /// As a matrix.
    pub(crate) fn ray_from_render(&self) -> Map<Ray, Render> {
        Map::new(DMat4::from_mat3(DMat3::from_cols(self.p, self.q, self.travel).transpose()))
    }
}

/// Height above the pole, 1 + d.y, below which the least rotation is no longer computed: at 1e-14 its entries have lost
/// two of f64's sixteen digits, and the frame is orthonormalised anyway. Smaller risks a division by zero; larger would
/// widen the cap in which the frame does not follow the light.
const POLE: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn frame_error(frame: &LightSpace) -> f64 {
        let matrix = DMat3::from_cols(frame.p, frame.q, frame.travel);
        let gram = matrix.transpose() * matrix - DMat3::IDENTITY;
        gram.to_cols_array().into_iter().fold(0.0, |worst: f64, entry| worst.max(entry.abs()))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Orthonormal and oriented for any direction, however near to an axis.
        #[test]
        fn a_frame_for_every_direction(axis in 0..6_usize, tilt in prop::array::uniform3(-1.0..1.0_f64), log in -320.0..1.0_f64) {
            let mut main = DVec3::ZERO;
            main[axis % 3] = if axis < 3 { 1.0 } else { -1.0 };
            let travel = (main + DVec3::from_array(tilt) * 10.0_f64.powf(log)).normalize_or(main);
            let frame = LightSpace::fixed(travel);
            prop_assert!(frame_error(&frame) < 1e-14);
            prop_assert!(frame.p.cross(frame.q).dot(frame.travel) < -0.999_999);
        }

        /// No jump: a small turn of the light turns the frame by at most (2/distance to the pole) times as much.
        #[test]
        fn the_fixed_frame_is_continuous(a in prop::array::uniform3(-1.0..1.0_f64), b in prop::array::uniform3(-1.0..1.0_f64), log in -12.0..-3.0_f64) {
            let Some(travel) = DVec3::from_array(a).try_normalize() else { return Ok(()) };
            let step = DVec3::from_array(b) * 10.0_f64.powf(log);
            let moved = (travel + step).normalize();
            let pole = (travel - DVec3::Y).length().min((moved - DVec3::Y).length());
            let (before, after) = (LightSpace::fixed(travel), LightSpace::fixed(moved));
            let change = (before.p - after.p).length().max((before.q - after.q).length());
            prop_assert!(change <= 8.0 * step.length() / pole.max(1e-9) + 1e-12);
        }
    }

    #[test]
    fn the_sun_overhead_sees_x_to_the_right() {
        let frame = LightSpace::fixed(-DVec3::Y);
        assert_eq!(frame.p, DVec3::X);
        assert_eq!(frame.q, -DVec3::Z);
    }
}
