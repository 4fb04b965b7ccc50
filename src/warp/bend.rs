//! The projective part of a map, apart from its window: `W = 1 + g · (x − o)`.
//!
//! Every warp of this crate bends the plane across the light by one such W and then lays a rectangle around what it has
//! bent. The strength is the vector g, so that it vanishes where it is short, whatever its direction: nothing jumps
//! where a published warp has no direction (view along the light). g = 0 is exactly the uniform map.
//!
//! # References
//! - `MATH.md` section 0, with g = κ â and o on the top line: the sides of the rectangle along â give the closed form.

use glam::{DVec2, DVec3};

use crate::math::homography::WarpFrame;

/// `W = 1 + gradient · (x − anchor)`, and the plane bent by it: `anchor + (x − anchor) / W`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    /// g: direction near to far, length κ; per world unit.
    pub(crate) gradient: DVec2,
    /// o: where W is 1; on the top line.
    pub(crate) anchor: DVec2,
}

/// Roundings of f64 in a bent coordinate: products with g and o (2), their sums (2), and as many in the rows of a
/// matrix. Fewer can leave the body's vertices outside; more costs texels only where the bent body is as small as
/// rounding.
pub(crate) const ROUNDINGS: f64 = 8.0;

impl Bend {
    /// No warp.
    pub(crate) const NONE: Self = Self { gradient: DVec2::ZERO, anchor: DVec2::ZERO };

    /// The warp of strength `kappa` (per world unit) in the frame of MATH.md section 0.
    pub(crate) fn new(frame: &WarpFrame, kappa: f64) -> Self {
        Self { gradient: frame.axis * kappa, anchor: frame.top }
    }

    /// Whether the map is affine.
    pub(crate) fn is_none(&self) -> bool {
        self.gradient == DVec2::ZERO
    }

    /// The same in a frame whose first axis is `axis` (unit).
    pub(crate) fn turned(self, axis: DVec2) -> Self {
        let turn = |vector: DVec2| DVec2::new(axis.dot(vector), axis.perp().dot(vector));
        Self { gradient: turn(self.gradient), anchor: turn(self.anchor) }
    }

    /// W at a point.
    pub(crate) fn w(&self, at: DVec2) -> f64 {
        1.0 + self.gradient.dot(at - self.anchor)
    }

    /// Where a point (W > 0) goes; itself, bit by bit, without a warp.
    pub(crate) fn bent(&self, at: DVec2) -> DVec2 {
        if self.is_none() {
            return at;
        }
        let w = self.w(at);
        (at + self.anchor * (w - 1.0)) / w
    }

    /// What goes to a bent point; the inverse of [`bent`](Self::bent). Finite before the horizon, `gradient · (bent −
    /// anchor) < 1`.
    pub(crate) fn unbent(&self, bent: DVec2) -> DVec2 {
        let from_anchor = bent - self.anchor;
        let w = 1.0 / (1.0 - self.gradient.dot(from_anchor));
        (bent - self.anchor * (1.0 - 1.0 / w)) * w
    }

    /// How far a box of half size `margin` around a point reaches once it is bent, to first order in each axis, and
    /// what f64 loses of it.
    pub(crate) fn reach(&self, at: DVec2, margin: f64) -> DVec2 {
        if self.is_none() {
            return DVec2::splat(margin);
        }
        let w = self.w(at);
        let bent = (at - self.anchor) / w;
        // A body far beside its centre line is bent by far more than its size.
        let (far, turn) = (self.anchor.length(), self.gradient.length());
        let lost = ROUNDINGS * f64::EPSILON * turn * (far + bent.length()) * (far + at.length()) / w;
        let side = |along: f64, gradient: DVec2, own: DVec2| {
            let row = own - gradient * along;
            (row.x.abs() + row.y.abs()) * margin / w + lost
        };
        DVec2::new(side(bent.x, self.gradient, DVec2::X), side(bent.y, self.gradient, DVec2::Y))
    }

    /// Rows over (p, q, r, 1): the numerators of the bent p and q, and W.
    pub(crate) fn rows(&self) -> [glam::DVec4; 3] {
        let bend = DVec3::new(self.gradient.x, self.gradient.y, 0.0).extend(-self.gradient.dot(self.anchor));
        [glam::DVec4::X + bend * self.anchor.x, glam::DVec4::Y + bend * self.anchor.y, glam::DVec4::W + bend]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::homography::Homography;
    use proptest::prelude::*;

    proptest! {
        /// Bent and back, and the rectangle along the axis is the closed form of the warp.
        #[test]
        fn there_and_back_again(angle in 0.0..6.3_f64, strength in 0.0..50.0_f64, points in prop::collection::vec(prop::array::uniform2(-3.0..5.0_f64), 3..12)) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from_array).collect();
            let frame = WarpFrame::around(DVec2::from_angle(angle), points[0], &points);
            let kappa = strength / frame.extent;
            let bend = Bend::new(&frame, kappa);
            let closed = Homography::fitted(&frame, kappa, &points);
            let turned = bend.turned(frame.axis);
            let along = |point: DVec2| DVec2::new(frame.axis.dot(point), frame.axis.perp().dot(point));
            let bent: Vec<DVec2> = points.iter().map(|point| turned.bent(along(*point))).collect();
            let low = bent.iter().copied().fold(DVec2::INFINITY, DVec2::min);
            let high = bent.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
            for (point, bent) in points.iter().zip(&bent) {
                prop_assert!((turned.unbent(*bent) - along(*point)).length() < 1e-9);
                // u runs down the map, c to its right.
                let ours = (*bent - low) / (high - low) * 2.0 - 1.0;
                let theirs = closed.map(*point);
                prop_assert!((ours.y - theirs.x).abs() < 1e-8 && (ours.x + theirs.y).abs() < 1e-8, "{} {}", ours, theirs);
            }
        }
    }

    #[test]
    fn no_warp_is_exact() {
        let at = DVec2::new(0.1, -1e7 / 3.0);
        assert_eq!(Bend::NONE.bent(at), at);
        assert_eq!(Bend { gradient: DVec2::ZERO, anchor: DVec2::new(3.3, 1e9) }.bent(at), at);
        assert_eq!(Bend::NONE.reach(at, 0.25), DVec2::splat(0.25));
        assert_eq!(Bend::NONE.rows(), [glam::DVec4::X, glam::DVec4::Y, glam::DVec4::W]);
    }
}
