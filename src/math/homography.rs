//! The one warp: a 2-D homography of strength κ, anchored on the top line of what it maps.
//!
//! Trapezoidal, light-space perspective and camera-space shadow maps and the uniform map are the same pencil of maps
//! and differ only in κ. In the frame of [`WarpFrame`], u runs from the top line (u = 0, near) to the base line (u = λ,
//! far) and c across it:
//!
//! ```text
//! (1)  W = 1 + κ u
//! (2)  X = (2 c − (a0 + a1) W) / (a1 − a0)
//! (3)  Y = 1 − u (2/λ + κ)                     map = (X/W, Y/W)
//! (4)  a0 = min c/W,  a1 = max c/W             over the hull: side lines through the centre of projection touch it
//! (5)  κ = (λ (1 − ξ) − 2 d') / (λ d' (1 + ξ)) the line u = d' goes to Y/W = ξ
//! (6)  n = d / (√(z1/z0) − 1)                  perspective errors at both ends of a range d are equal; κ = 1/n
//! ```
//!
//! The top line goes to Y/W = 1, the base line to −1; W = 1 on the top line and k = 1 + κλ on the base line; κ is one
//! over the distance from the centre of projection to the top line. κ = 0 is *exactly* affine: uniform maps need no
//! special case. The sense of rotation is kept (determinant > 0).
//!
//! Everything here is total: nothing panics, nothing allocates, and numbers that are not finite give the uniform map.
//!
//! # References
//! - Martin & Tan, *Anti-aliasing and continuity with trapezoidal shadow maps*, 2004: (4), and (5) with ξ = −0.6.
//! - Wimmer, Scherzer & Purgathofer, *Light space perspective shadow maps*, 2004: (6).
//! - Scherzer, *Robust shadow maps for large environments*, 2005: eq. (1) and (2).

use glam::{DMat3, DVec2, DVec3};

/// Largest κλ, that is, k − 1 where k is the ratio of W (and of texel density along the sides) from top to base line.
///
/// The strength of the 80 % rule grows like 4/d' as the focus nears the top line. At 0 every map is uniform. Without a
/// limit, hardly a texel is left for what lies behind the top line, and rounding of f32 matrices (some 4e-4 texels of
/// 2048 × k × distance from the origin over λ) shows. 1e3 keeps the optimal strengths of light-space perspective,
/// √(far/near), up to 1e6.
pub const STRONGEST: f64 = 1e3;

/// Least width or extent of a map, as a share of its distance from the origin of coordinates and its size. At 0 flat
/// hulls divide by zero; much above 1e-12 slim bodies would get a map wider than they are. 1e-12 is some thousand
/// roundings of f64.
const THINNEST: f64 = 1e-12;

/// Least width or extent of a map in the units of the plane, where everything lies in the origin: products of four
/// inverses stay finite.
const SMALLEST: f64 = 1e-60;

/// Coordinates from here on are treated as not finite: products of four stay finite.
const LARGEST: f64 = 1e60;

/// The line that closes 80 % of a map from the top: y = 1 − 2 · 0.8 (trapezoidal shadow maps).
pub const LINE_80_PERCENT: f64 = -0.6;

/// The middle of a map: half of it lies before the focus (camera-space shadow maps).
pub const LINE_HALF: f64 = 0.0;

/// Two thirds of a map lie before the focus (Filament's least n for light-space perspective).
pub const LINE_TWO_THIRDS: f64 = -1.0 / 3.0;

/// The frame a warp is laid in: a centre line, and how far the hull reaches along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WarpFrame {
    /// Where the centre line meets the top line, in units of the plane: u = 0 and c = 0.
    pub top: DVec2,
    /// Direction of the centre line, unit length, near to far: the direction of u. c grows along its left normal.
    pub axis: DVec2,
    /// λ > 0: distance from top to base line, in units of the plane.
    pub extent: f64,
}

impl WarpFrame {
    /// The frame around `hull` whose centre line passes through `through` along `axis` (any length).
    ///
    /// The top line touches the hull where u is least, the base line where it is greatest. Points that are not finite
    /// (or beyond 1e60) are ignored; an axis without direction is +x; a hull without extent gets one, rounding wide.
    /// O(points).
    #[must_use]
    pub fn around(axis: DVec2, through: DVec2, hull: &[DVec2]) -> Self {
        // Axes may be so short that their squares underflow; one without direction becomes NaN here.
        let scaled = axis / axis.abs().max_element();
        let axis = if scaled.is_finite() { scaled.normalize_or(DVec2::X) } else { DVec2::X };
        let through = if usable(&through) { through } else { centre(hull) };
        // Least and greatest u from `through`.
        let (low, high) = range(hull, |point| (point - through).dot(axis));
        let reach = reach(hull).max(through.length());
        let extent = (high - low).max(reach * THINNEST).max(SMALLEST);
        Self { top: through + axis * low, axis, extent }
    }

    /// (u, c) of a point: u along the axis from the top line, c to the left of the centre line.
    #[must_use]
    pub fn coordinates(&self, point: DVec2) -> DVec2 {
        let from_top = point - self.top;
        DVec2::new(from_top.dot(self.axis), from_top.dot(self.axis.perp()))
    }

    /// The point at (u, c).
    #[must_use]
    pub fn point(&self, u: f64, c: f64) -> DVec2 {
        self.top + self.axis * u + self.axis.perp() * c
    }

    /// κ limited to what this frame takes: 0 ≤ κλ ≤ [`STRONGEST`], 0 for NaN.
    #[must_use]
    pub fn limited(&self, kappa: f64) -> f64 {
        limited(kappa, self.extent)
    }

    /// Side lines (4): the least and greatest c/W over `hull`, at strength `kappa` (limited).
    ///
    /// Exact: c/W is monotone along every line, so that its extremes over a convex hull are at vertices. Sides that
    /// coincide are moved apart by a rounding. O(points).
    #[must_use]
    pub fn sides(&self, kappa: f64, hull: &[DVec2]) -> [f64; 2] {
        let kappa = self.limited(kappa);
        let (low, high) = range(hull, |point| {
            let at = self.coordinates(point);
            // Points before the top line are no part of the hull the frame was laid around.
            at.y / (1.0 + kappa * at.x.max(0.0))
        });
        let least = (reach(hull).max(self.top.length()) * THINNEST).max(SMALLEST);
        let widen = 0.5 * (least - (high - low)).max(0.0);
        [low - widen, high + widen]
    }
}

/// Rows that take (x, y, 1) of the plane to homogeneous coordinates of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homography {
    /// Row of X: X/W in [−1, 1] over the hull.
    pub x: DVec3,
    /// Row of Y: Y/W is 1 on the top line, −1 on the base line.
    pub y: DVec3,
    /// Row of W: 1 on the top line, 1 + κλ on the base line; (0, 0, 1) exactly where κ = 0.
    pub w: DVec3,
}

impl Homography {
    /// The warp of strength `kappa` (limited) whose side lines touch `hull`: (1) to (4). O(points).
    #[must_use]
    pub fn fitted(frame: &WarpFrame, kappa: f64, hull: &[DVec2]) -> Self {
        Self::between(frame, kappa, frame.sides(kappa, hull))
    }

    /// The warp of strength `kappa` (limited) between the side lines c/W = `sides[0]` and `sides[1]`: (1) to (3).
    ///
    /// `sides` must be finite and ascending, as those of [`WarpFrame::sides`] are.
    #[must_use]
    pub fn between(frame: &WarpFrame, kappa: f64, sides: [f64; 2]) -> Self {
        let kappa = frame.limited(kappa);
        let [a0, a1] = sides;
        // u and c as rows.
        let row = |direction: DVec2| direction.extend(-direction.dot(frame.top));
        let (u, c) = (row(frame.axis), row(frame.axis.perp()));
        let w = DVec3::Z + kappa * u; // (1)
        let x = (2.0 * c - (a0 + a1) * w) / (a1 - a0); // (2)
        let y = DVec3::Z - (2.0 / frame.extent + kappa) * u; // (3)
        Self { x, y, w }
    }

    /// (X, Y, W) of a point.
    #[must_use]
    pub fn homogeneous(&self, point: DVec2) -> DVec3 {
        let point = point.extend(1.0);
        DVec3::new(self.x.dot(point), self.y.dot(point), self.w.dot(point))
    }

    /// Where a point with W > 0 is on the map: (X/W, Y/W).
    #[must_use]
    pub fn map(&self, point: DVec2) -> DVec2 {
        let at = self.homogeneous(point);
        at.truncate() / at.z
    }

    /// The rows as a matrix.
    #[must_use]
    pub fn map_from_plane(&self) -> DMat3 {
        DMat3::from_cols(self.x, self.y, self.w).transpose()
    }

    /// Determinant: 4 (1/λ + κ) / (a1 − a0) > 0; the sense of rotation is kept where W > 0.
    #[must_use]
    pub fn determinant(&self) -> f64 {
        self.x.cross(self.y).dot(self.w)
    }
}

/// κ that takes the line at `focus` from the top to Y/W = `line`: equation (5), limited to 0 ≤ κλ ≤ [`STRONGEST`].
///
/// `extent` is λ > 0, `focus` is d' in the same units, both measured from the *top line* (not from the near plane);
/// `line` is ξ in (−1, 1): [`LINE_80_PERCENT`], [`LINE_HALF`], [`LINE_TWO_THIRDS`]. A focus at or beyond λ (1 − ξ)/2,
/// where a uniform map already has the line, gives 0; a focus at or before the top line gives the limit. NaN gives 0.
///
/// Erratum TH-1: the thesis prints ξ = 1.6 for the 80 % line. With that the centre of projection is on the wrong side
/// for every d' > 0; the line is y = 1 − 2 · 0.8 = −0.6.
#[must_use]
pub fn kappa_for_line(extent: f64, focus: f64, line: f64) -> f64 {
    if focus.is_nan() || !(-1.0..1.0).contains(&line) {
        return 0.0;
    }
    // Adding zero turns −0 into +0: the sign of a quotient by it must be that of the limit.
    let focus = focus.max(0.0) + 0.0;
    let kappa = (extent * (1.0 - line) - 2.0 * focus) / (extent * focus * (1.0 + line));
    limited(kappa, extent)
}

/// κ limited to 0 ≤ κλ ≤ [`STRONGEST`]; 0 where either is NaN or λ is not positive and finite.
#[must_use]
pub fn limited(kappa: f64, extent: f64) -> f64 {
    if kappa.is_nan() || !(extent > 0.0 && extent.is_finite()) {
        return 0.0;
    }
    kappa.clamp(0.0, STRONGEST / extent)
}

/// n of light-space perspective, equation (6): equal perspective error at both ends of a range.
///
/// `range` is d, the extent of the map along its axis in light space; `nearest` and `farthest` are the eye depths z0,
/// z1 at its two ends. All in one unit, 0 < z0 < z1. κ = 1/n, anchored at the least u of the body; anything else gives
/// ∞ (uniform).
///
/// Erratum SC-2: eq. (2) of Scherzer anchors the near plane at the eye plus `z_n` along the axis, which is the least u
/// of the body only for light across the view; otherwise W ≤ 0 inside the body happens. [`WarpFrame`] anchors at the
/// least u.
#[must_use]
pub fn n_opt(range: f64, nearest: f64, farthest: f64) -> f64 {
    positive_or_uniform(range / ((farthest / nearest).sqrt() - 1.0))
}

/// n of light-space perspective for directional light: (`z_n` + √(`z_n` `z_f`)) / sin γ with `z_f` = `z_n` + d sin γ.
///
/// `range` is d in light space, `sin_gamma` the sine of the angle between light and view direction. The same as
/// [`n_opt`] with z1 = z0 + d sin γ. Worse than uniform where γ is less than half the field of view: a matter for the
/// caller.
#[must_use]
pub fn n_opt_directional(near: f64, range: f64, sin_gamma: f64) -> f64 {
    n_opt_eye_range(near, range * sin_gamma, sin_gamma)
}

/// Scherzer's eq. (1): (`z_n` + √(`z_n` (`z_n` + Δz))) / sin γ, with Δz a range of *eye depth*.
///
/// Erratum SC-1: the text calls Δz the "depth extent of B in light space", which is d; the formula is right only for Δz
/// = `z_f` − `z_n` = d sin γ. Published code differs in just these arguments: the 2004 demo passes near / sin γ and d
/// sin γ; the 2006 demo's older function passes the eye range times sin γ, a sine too many.
#[must_use]
pub fn n_opt_eye_range(near: f64, eye_range: f64, sin_gamma: f64) -> f64 {
    positive_or_uniform((near + (near * (near + eye_range)).sqrt()) / sin_gamma)
}

/// Ogre's default: a tenth of near + √(near far), a warp ten times stronger than equal errors call for; 0 there means
/// uniform.
#[must_use]
pub fn n_opt_simple(near: f64, far: f64) -> f64 {
    /// Ogre's factor; at 1 it is the optimum for light across the view, at 0 the centre of projection is on the near
    /// plane.
    const FACTOR: f64 = 0.1;
    positive_or_uniform(FACTOR * (near + (near * far).sqrt()))
}

/// n itself where it is a distance, ∞ (κ = 0) where it is not.
fn positive_or_uniform(n: f64) -> f64 {
    if n > 0.0 { n } else { f64::INFINITY }
}

/// True for points whose products stay finite.
fn usable(point: &DVec2) -> bool {
    point.abs().max_element() < LARGEST && !point.is_nan()
}

/// Least and greatest of a quantity over the points that are usable; (0, 0) where none is.
fn range(hull: &[DVec2], quantity: impl Fn(DVec2) -> f64) -> (f64, f64) {
    let mut range: Option<(f64, f64)> = None;
    for point in hull.iter().filter(|point| usable(point)) {
        let at = quantity(*point);
        range = Some(range.map_or((at, at), |(low, high)| (low.min(at), high.max(at))));
    }
    range.unwrap_or((0.0, 0.0))
}

/// Largest distance of a usable point from the origin of coordinates.
fn reach(hull: &[DVec2]) -> f64 {
    range(hull, DVec2::length_squared).1.sqrt()
}

/// Centre of the box around the usable points.
fn centre(hull: &[DVec2]) -> DVec2 {
    let ((left, right), (down, up)) = (range(hull, |point| point.x), range(hull, |point| point.y));
    DVec2::new(left.midpoint(right), down.midpoint(up))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [DVec2; 4] = [DVec2::new(3.0, 1.0), DVec2::new(5.0, 1.0), DVec2::new(5.0, 2.0), DVec2::new(3.0, 2.0)];

    #[test]
    fn no_strength_is_exactly_affine() {
        let frame = WarpFrame::around(DVec2::new(0.6, 0.8), DVec2::new(4.0, 1.5), &SQUARE);
        for kappa in [0.0, -0.0, -3.0, f64::NAN, f64::NEG_INFINITY] {
            let warp = Homography::fitted(&frame, kappa, &SQUARE);
            assert_eq!(warp.w, DVec3::Z);
            assert!(warp.determinant() > 0.0);
        }
    }

    #[test]
    fn strength_is_limited() {
        assert_eq!(limited(f64::INFINITY, 4.0), STRONGEST / 4.0);
        assert_eq!(kappa_for_line(4.0, 0.0, LINE_80_PERCENT), STRONGEST / 4.0);
        assert_eq!(kappa_for_line(4.0, -0.0, LINE_80_PERCENT), STRONGEST / 4.0);
        assert_eq!(kappa_for_line(4.0, 3.3, LINE_80_PERCENT), 0.0);
        for broken in [f64::NAN, f64::INFINITY] {
            assert_eq!(kappa_for_line(broken, 1.0, LINE_80_PERCENT), 0.0);
            assert_eq!(kappa_for_line(4.0, broken, LINE_80_PERCENT), 0.0);
            assert_eq!(kappa_for_line(4.0, 1.0, broken), 0.0);
            assert_eq!(limited(1.0, broken), 0.0);
        }
        assert_eq!(kappa_for_line(-1.0, 0.1, LINE_HALF), 0.0);
    }

    #[test]
    fn what_is_no_distance_is_uniform() {
        for n in
            [n_opt(1.0, 2.0, 2.0), n_opt(1.0, 2.0, 1.0), n_opt_directional(1.0, 9.0, 0.0), n_opt(f64::NAN, 1.0, 2.0)]
        {
            assert_eq!(n, f64::INFINITY);
            assert_eq!(limited(1.0 / n, 1.0), 0.0);
        }
    }

    /// Flat, single, empty, huge and broken hulls give finite rows and keep the sense of rotation.
    #[test]
    fn total() {
        let broken = [DVec2::NAN, DVec2::INFINITY, DVec2::splat(1e200)];
        let flat = [DVec2::new(1e6, -2.0), DVec2::new(1e6, 3.0)];
        let dot = [DVec2::ZERO];
        let hulls: [&[DVec2]; 6] = [&[], &broken, &flat, &dot, &SQUARE, &[DVec2::splat(-1e59), DVec2::splat(1e59)]];
        for hull in hulls {
            for axis in [DVec2::X, DVec2::new(0.3, -0.9), DVec2::ZERO, DVec2::NAN, DVec2::INFINITY] {
                for through in [DVec2::ZERO, DVec2::NAN, DVec2::splat(5.0)] {
                    for kappa in [0.0, 1.0, f64::INFINITY, f64::NAN] {
                        let frame = WarpFrame::around(axis, through, hull);
                        let warp = Homography::fitted(&frame, kappa, hull);
                        assert!(warp.map_from_plane().is_finite(), "{hull:?} {axis} {through} {kappa}: {warp:?}");
                        assert!(warp.determinant() >= 0.0, "{hull:?} {axis} {through} {kappa}: {warp:?}");
                    }
                }
            }
        }
    }

    /// A view that leaves the light by 1e-161 radians has a direction, whose square underflows: the axis came out too
    /// long by a tenth.
    #[test]
    fn short_axes_are_directions() {
        for log in [-320, -161, 0, 161, 300] {
            let axis = WarpFrame::around(DVec2::new(3.0, -4.0) * 10_f64.powi(log), DVec2::ZERO, &SQUARE).axis;
            assert!((axis.length() - 1.0).abs() < 1e-15, "{log}: {axis}");
        }
    }
}
