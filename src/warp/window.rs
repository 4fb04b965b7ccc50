//! Windows: the rectangle, across the light, that a map shows. Bent first where the map is warped; as it is in uniform
//! maps.
//!
//! # References
//! - Williams, *Casting curved shadows on curved surfaces*, 1978 (the standard shadow map).
//! - Brabec, Annen & Seidel, *Practical shadow mapping*, 2002 (focusing it on what is visible).
//! - `MATH.md` section 0 (side lines, fitted after the warp); section 4, crop.

use glam::{DVec2, DVec3, DVec4};

use super::bend::Bend;
use crate::light_space::LightSpace;
use crate::math::convex::MAX_VERTICES;
use crate::math::rectangle::steady_axis;
use crate::math::space::{Clip, Map, Ray};

/// The extent of a map across the light: a rectangle of bent (p, q) in the map's own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// The frame whose axes are the sides of the map.
    pub(crate) light: LightSpace,
    /// How (p, q) of that frame are bent.
    pub(crate) bend: Bend,
    /// Smallest bent (p, q) that must be inside.
    pub(crate) low: DVec2,
    /// Largest bent (p, q) that must be inside.
    pub(crate) high: DVec2,
}

impl Window {
    /// Around `vertices` and `margin` world units more, in a frame that is given; `bend` is in that frame.
    pub(crate) fn around(light: LightSpace, bend: Bend, vertices: &[DVec3], margin: f64) -> Self {
        let (low, high) = vertices.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), vertex| {
            let across = light.ray(*vertex).truncate();
            let (bent, reach) = (bend.bent(across), bend.reach(across, margin));
            (low.min(bent - reach), high.max(bent + reach))
        });
        // W is narrowed apart from p and q: what it loses moves a vertex by as much of its distance from the middle.
        let lost = (high - low) * (0.5 * margin * bend.gradient.abs().element_sum());
        Self { light, bend, low: low - lost, high: high + lost }
    }

    /// The same, in a frame in which the window is nearly the smallest, and that turns continuously with the body.
    pub(crate) fn steady(light: LightSpace, bend: Bend, vertices: &[DVec3], margin: f64) -> Self {
        let across = vertices.iter().map(|vertex| bend.bent(light.ray(*vertex).truncate()));
        Self::turned(light, bend, steady_axis::<MAX_VERTICES>(across).unwrap_or(DVec2::X), vertices, margin)
    }

    /// The same, with a side of the window along `axis` of the frame `light`.
    pub(crate) fn turned(light: LightSpace, bend: Bend, axis: DVec2, vertices: &[DVec3], margin: f64) -> Self {
        Self::around(light.turned(axis), bend.turned(axis), vertices, margin)
    }

    /// Width and height, world units where W = 1.
    pub(crate) fn size(&self) -> DVec2 {
        self.high - self.low
    }

    /// Width times height.
    pub(crate) fn area(&self) -> f64 {
        self.size().element_product()
    }

    /// Grown by a border (bent units) on every side.
    pub(crate) fn bordered(&self, border: DVec2) -> Self {
        Self { low: self.low - border, high: self.high + border, ..*self }
    }

    /// Its corners in (p, q), unbent. None where one lies at or beyond the horizon: the window has no end there.
    pub(crate) fn corners(&self) -> Option<[DVec2; 4]> {
        let (low, high) = (self.low, self.high);
        let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        let ends = corners.iter().all(|corner| self.bend.gradient.dot(*corner - self.bend.anchor) < 1.0);
        ends.then(|| corners.map(|corner| self.bend.unbent(corner)))
    }

    /// The sides of a texel at a point (p, q) of the frame, world units across the light; `texel` is their length, bent
    /// units.
    ///
    /// Exact derivative of [`Bend::unbent`]: W (e + (g · e) (x − o)).
    pub(crate) fn texel_at(&self, at: DVec2, texel: DVec2) -> [DVec2; 2] {
        let (w, gradient, from_anchor) = (self.bend.w(at), self.bend.gradient, at - self.bend.anchor);
        [(DVec2::X + gradient.x * from_anchor) * w * texel.x, (DVec2::Y + gradient.y * from_anchor) * w * texel.y]
    }

    /// The four half-spaces of (p, q, r, 1) that it lies in: left, right, lower, upper.
    pub(crate) fn sides(&self) -> [DVec4; 4] {
        let [p, q, w] = self.bend.rows();
        [p - w * self.low.x, w * self.high.x - p, q - w * self.low.y, w * self.high.y - q]
    }

    /// The map's clip space: the window to [−1, 1]², depth from `near` to `far` along the light to [0, 1], linearly.
    pub(crate) fn clip_from_ray(&self, near: f64, far: f64) -> Map<Clip, Ray> {
        let [p, q, w] = self.bend.rows();
        let (sum, size) = (self.low + self.high, self.size());
        let depth = DVec4::new(0.0, 0.0, 1.0 / (far - near), -near / (far - near));
        Map::from_rows([(p * 2.0 - w * sum.x) / size.x, (q * 2.0 - w * sum.y) / size.y, depth, w])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// MATH.md section 4: lo = (-.5, -.25, .1), hi = (.5, .75, .6) gives s = (2, 2, 2), o = (0, -.5, -.2).
    #[test]
    fn crop_golden_values() {
        let (low, high) = (DVec2::new(-0.5, -0.25), DVec2::new(0.5, 0.75));
        let window = Window { light: LightSpace::fixed(-DVec3::Y), bend: Bend::NONE, low, high };
        let crop = window.clip_from_ray(0.1, 0.6);
        for (row, expected) in
            [DVec4::new(2.0, 0.0, 0.0, 0.0), DVec4::new(0.0, 2.0, 0.0, -0.5), DVec4::new(0.0, 0.0, 2.0, -0.2), DVec4::W]
                .into_iter()
                .enumerate()
        {
            assert!((crop.row(row) - expected).length() < 1e-15);
        }
    }
}
