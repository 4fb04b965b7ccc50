//! Trapezoidal shadow maps: what is in view, as the light sees it, in a trapezoid, and the trapezoid on a square.
//!
//! The plane is the light's post-perspective space without its depth. From the hull of what is in view to the map:
//!
//! 1. *Centre line* l: from the centre of the near plane to that of the far plane.
//! 2. *Top line* and *base line*: across l, touching the hull at its near and at its far end, λ apart.
//! 3. *Centre of projection* q on l, η before the top line, such that the focus point `P_L`, d' after the top line,
//!    comes to lie on the line y = ξ of the map: η = λ d' (1 + ξ) / (λ − 2 d' − λ ξ). The 80 % rule is ξ = −0.6.
//! 4. *Side lines*: through q, touching the hull on both sides.
//! 5. `N_T` takes the corners t0 t1 (base) t2 t3 (top) to (−1, −1), (1, −1), (1, 1), (−1, 1).
//!
//! [`Trapezoid::map_from_light`] is `N_T` in closed form: the homography of strength κ = 1/η, which is regular also
//! where the sides are parallel (κ = 0). [`chain`] is `N_T` as published, a product of eight matrices, for reading and
//! for testing.
//!
//! # Where this differs from print
//! - TH-1: the 80 % line is printed as ξ = 1.6; it is −0.6 ([`LINE_80_PERCENT`]).
//! - TH-2: the printed T2 has a stray `u_y` off its diagonal; it is a pure translation.
//! - TH-3: the printed N ends in the row (0 1 0 1) and is singular; the row is (0 1 0 0).
//! - TH-4: "the front side of the unit cube, z = 1" is not reached: z/w is 1/k at the base. Only x and y are on the
//!   square, so that depth has to be kept apart.
//!
//! # References
//! - Martin & Tan, *Anti-aliasing and continuity with trapezoidal shadow maps*, 2004, and its *Recipe*: `N_T`, the 80 %
//!   rule.
//! - The thesis whose errata are named TH: *Shadow mapping remix approach*, section 3.2.2 and appendix A (η, q, side
//!   lines).

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::Focus;
use super::sight::{Choice, Sight};
use crate::camera::{Camera, Projection};
pub use crate::math::homography::LINE_80_PERCENT;
use crate::math::homography::{Homography, WarpFrame, kappa_for_line};

/// Centre lines shorter than this share of the hull's diameter have no direction: view and light are parallel, and the
/// map is uniform. At 0 the direction is rounding noise; at 1 every map is uniform. 1e-3 is a view within 0.06° of the
/// light.
const NO_DIRECTION: f64 = 1e-3;

/// The published warp for a focus (E is what is in view, the light's post-perspective space its plane).
pub(crate) fn choose(camera: &Camera, sight: &Sight, focus: Focus) -> Choice {
    let (near, far) = sight.depth_range();
    let beyond = match focus {
        Focus::Share(share) => f64::from(share) * (far - near),
        Focus::Distance(distance) => f64::from(distance),
    };
    // l runs through the middle of the picture.
    let middle = camera.projection.middle();
    let image = |depth: f64| {
        let aside = match camera.projection {
            Projection::Perspective { .. } => middle * depth,
            Projection::Orthographic { .. } => middle,
        };
        sight.eye + sight.view * depth + sight.right * aside.x + sight.up * aside.y
    };
    let centres = [image(near), image(far)];
    let (frame, _, kappa) = laid(centres, &sight.points, image(near + beyond), LINE_80_PERCENT);
    Choice { frame, strength: kappa * frame.extent }
}

/// Steps 1 to 3: the frame along l, d', and 1/η.
fn laid([near, far]: [DVec2; 2], hull: &[DVec2], focus_point: DVec2, line: f64) -> (WarpFrame, f64, f64) {
    let frame = WarpFrame::around(far - near, near, hull);
    let focus = frame.coordinates(focus_point).x;
    // Uniform where the centre line has no direction.
    let diameter = hull.iter().map(|point| point.distance_squared(near)).fold(0.0, f64::max).sqrt();
    let directed = far.distance(near) > NO_DIRECTION * diameter;
    let kappa = if directed { kappa_for_line(frame.extent, focus, line) } else { 0.0 };
    (frame, focus, kappa)
}

/// A trapezoid around what is in view, as the light sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trapezoid {
    /// Where l meets the top line, the direction of l, and λ.
    pub frame: WarpFrame,
    /// d': how far the focus point lies after the top line, along l; units of the plane.
    pub focus: f64,
    /// 1/η ≥ 0, per unit of the plane; 0 where the focus is at or after the line already (parallel sides).
    pub kappa: f64,
    /// Side lines as c/W, ascending.
    pub sides: [f64; 2],
}

impl Trapezoid {
    /// Steps 1 to 4 for a hull (its points in any order; inner points do no harm).
    ///
    /// `centres` are the images of the centres of the near and of the far plane, `focus_point` that of `P_L`, and
    /// `line` is ξ in (−1, 1), [`LINE_80_PERCENT`] in the papers. No allocation, total: a centre line without
    /// direction, a focus at or after the line, and numbers that are not finite give parallel sides. O(points).
    #[must_use]
    pub fn around(centres: [DVec2; 2], hull: &[DVec2], focus_point: DVec2, line: f64) -> Self {
        let (frame, focus, kappa) = laid(centres, hull, focus_point, line);
        Self { frame, focus, kappa, sides: frame.sides(kappa, hull) }
    }

    /// t0, t1 on the base line (far), t2, t3 on the top line (near), in the order in which they go to (−1, −1), (1,
    /// −1), (1, 1), (−1, 1): counter-clockwise.
    #[must_use]
    pub fn corners(&self) -> [DVec2; 4] {
        let [a0, a1] = self.sides;
        let (extent, ratio) = (self.frame.extent, 1.0 + self.kappa * self.frame.extent);
        [
            self.frame.point(extent, a0 * ratio),
            self.frame.point(extent, a1 * ratio),
            self.frame.point(0.0, a1),
            self.frame.point(0.0, a0),
        ]
    }

    /// q, where the side lines meet; none where they are parallel.
    #[must_use]
    pub fn centre_of_projection(&self) -> Option<DVec2> {
        (self.kappa > 0.0).then(|| self.frame.point(-self.kappa.recip(), 0.0))
    }

    /// `N_T` in closed form.
    #[must_use]
    pub fn map_from_light(&self) -> Homography {
        Homography::between(&self.frame, self.kappa, self.sides)
    }
}

/// `N_T` = S2 T3 N S1 H T2 R T1 as published and corrected: eight matrices that move a trapezoid onto a square.
///
/// Points are columns (x, y, 1, 1); `corners` are t0 t1 (base) and t2 t3 (top). Each function is one matrix, and takes
/// the corners where the matrices before it have left them. Not used for drawing: it has no answer for parallel sides
/// and loses digits near them.
pub mod chain {
    use super::{DMat4, DVec2, DVec3, DVec4};

    /// The whole chain, up to scale; none where the side lines are parallel.
    #[must_use]
    pub fn map_from_light(corners: [DVec2; 4]) -> Option<DMat4> {
        let light = corners.map(homogeneous);
        let top_from_light = top_from_light(light);
        let upright_from_light = upright_from_top(moved(top_from_light, light)) * top_from_light;
        let apex_from_light = apex_from_upright(moved(upright_from_light, light))? * upright_from_light;
        let isosceles_from_light = isosceles_from_apex(moved(apex_from_light, light)) * apex_from_light;
        let unit_from_light = unit_from_isosceles(moved(isosceles_from_light, light)) * isosceles_from_light;
        let rectangle_from_light = rectangle_from_unit() * unit_from_light;
        let middle_from_light = middle_from_rectangle(moved(rectangle_from_light, light)) * rectangle_from_light;
        Some(map_from_middle(moved(middle_from_light, light)) * middle_from_light)
    }

    /// T1. Slides the trapezoid until the middle of its top line is in the origin.
    #[must_use]
    pub fn top_from_light([_, _, t2, t3]: [DVec4; 4]) -> DMat4 {
        translation(-top_middle(t2, t3))
    }

    /// R. Turns it until the top line lies along x and the base line above it, at greater y (turned over, as in print:
    /// it is a reflection, and S1 undoes that).
    #[must_use]
    pub fn upright_from_top([_, _, t2, t3]: [DVec4; 4]) -> DMat4 {
        let u = (flat(t2) - flat(t3)).normalize_or(DVec2::X);
        rows([
            DVec4::new(u.x, u.y, 0.0, 0.0),
            DVec4::new(u.y, -u.x, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 1.0, 0.0),
            DVec4::new(0.0, 0.0, 0.0, 1.0),
        ])
    }

    /// T2. Slides it until q, where the side lines meet, is in the origin; none where they are parallel.
    ///
    /// Erratum TH-2: printed with a stray `u_y` at (1, 2) and (2, 1); it is a pure translation.
    #[must_use]
    pub fn apex_from_upright(corners: [DVec4; 4]) -> Option<DMat4> {
        let [t0, t1, t2, t3] = corners.map(flat);
        // Where the line from t3 along its side meets the line through t1 and t2.
        let (left, right) = (t0 - t3, t1 - t2);
        let along = (t2 - t3).perp_dot(right) / left.perp_dot(right);
        along.is_finite().then(|| translation(-(t3 + left * along)))
    }

    /// H. Shears it along x until the middle of the top line is straight above q: the sides become symmetric about the
    /// y axis.
    #[must_use]
    pub fn isosceles_from_apex([_, _, t2, t3]: [DVec4; 4]) -> DMat4 {
        let u = top_middle(t2, t3);
        rows([DVec4::new(1.0, -u.x / u.y, 0.0, 0.0), DVec4::Y, DVec4::Z, DVec4::W])
    }

    /// S1. Scales it until the side lines are x = ±y and the top line is y = 1.
    #[must_use]
    pub fn unit_from_isosceles([_, _, t2, _]: [DVec4; 4]) -> DMat4 {
        let u = flat(t2);
        DMat4::from_scale(DVec3::new(1.0 / u.x, 1.0 / u.y, 1.0))
    }

    /// N. Looks at it from q: x/y and 1 + 1/y. The sides become parallel and the trapezoid a rectangle, with its top at
    /// y = 2.
    ///
    /// Erratum TH-3: printed with the last row (0 1 0 1), which repeats the second and makes `N_T` singular. Erratum
    /// TH-4: z is kept and w grows, so that z/w falls from 1 on the top line to 1/k on the base line.
    #[must_use]
    pub fn rectangle_from_unit() -> DMat4 {
        rows([DVec4::X, DVec4::new(0.0, 1.0, 0.0, 1.0), DVec4::Z, DVec4::Y])
    }

    /// T3. Slides the rectangle along y until its middle is in the origin.
    #[must_use]
    pub fn middle_from_rectangle([t0, _, t2, _]: [DVec4; 4]) -> DMat4 {
        translation(DVec2::new(0.0, -0.5 * (t0.y / t0.w + t2.y / t2.w)))
    }

    /// S2. Scales it along y until the base line is at −1 and, with it, the top line at 1: a square.
    #[must_use]
    pub fn map_from_middle([t0, ..]: [DVec4; 4]) -> DMat4 {
        DMat4::from_scale(DVec3::new(1.0, -t0.w / t0.y, 1.0))
    }

    /// A point of the light's plane as the papers write it: (x, y, 1, 1).
    #[must_use]
    pub fn homogeneous(point: DVec2) -> DVec4 {
        point.extend(1.0).extend(1.0)
    }

    fn moved(to_from: DMat4, corners: [DVec4; 4]) -> [DVec4; 4] {
        corners.map(|corner| to_from * corner)
    }

    fn flat(point: DVec4) -> DVec2 {
        point.truncate().truncate() / point.w
    }

    fn top_middle(t2: DVec4, t3: DVec4) -> DVec2 {
        0.5 * (flat(t2) + flat(t3))
    }

    fn translation(by: DVec2) -> DMat4 {
        DMat4::from_translation(by.extend(0.0))
    }

    fn rows([x, y, z, w]: [DVec4; 4]) -> DMat4 {
        DMat4::from_cols(x, y, z, w).transpose()
    }
}
