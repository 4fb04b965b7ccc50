//! Matrices that know where they come from and where they go: composing them in the wrong order does not compile.

use core::marker::PhantomData;
use core::ops::Mul;

use glam::{DMat4, DVec3, DVec4, Mat4, Vec4};

/// World space shifted by the caller's `origin`: what the GPU sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Render;

/// Coordinates of the light's pencil: `(p, q)` across the rays, `r` along the travel of light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray;

/// Clip space of a map: x, y in [-1, 1], z in [0, 1] with 0 nearest to the light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clip;

/// A homogeneous map from one space to another, in f64.
#[derive(Debug)]
pub(crate) struct Map<To, From>(pub(crate) DMat4, PhantomData<(To, From)>);

impl<To, From> Clone for Map<To, From> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<To, From> Copy for Map<To, From> {}

impl<To, From> Map<To, From> {
    /// Declares what a matrix maps.
    pub(crate) const fn new(to_from: DMat4) -> Self {
        Self(to_from, PhantomData)
    }

    /// The one narrowing to f32 of a matrix that leaves the crate.
    pub(crate) fn narrow(&self) -> Mat4 {
        self.0.as_mat4()
    }

    /// Row `index` narrowed to f32.
    pub(crate) fn narrow_row(&self, index: usize) -> Vec4 {
        self.0.row(index).as_vec4()
    }

    /// Row `index` in f64.
    pub(crate) fn row(&self, index: usize) -> DVec4 {
        self.0.row(index)
    }
}

impl<To, Mid, From> Mul<Map<Mid, From>> for Map<To, Mid> {
    type Output = Map<To, From>;
    fn mul(self, rhs: Map<Mid, From>) -> Map<To, From> {
        Map::new(self.0 * rhs.0)
    }
}

impl Map<Clip, Ray> {
    /// The affine map that takes the box `[low, high]` of ray coordinates to the clip volume.
    pub(crate) fn crop(low: DVec3, high: DVec3) -> Self {
        let size = high - low;
        let scale = DVec3::new(2.0 / size.x, 2.0 / size.y, 1.0 / size.z);
        let offset = DVec3::new(-(high.x + low.x) / size.x, -(high.y + low.y) / size.y, -low.z / size.z);
        Self::new(DMat4::from_cols(
            DVec4::new(scale.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, scale.y, 0.0, 0.0),
            DVec4::new(0.0, 0.0, scale.z, 0.0),
            offset.extend(1.0),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// MATH.md section 4: lo = (-.5, -.25, .1), hi = (.5, .75, .6) gives s = (2, 2, 2), o = (0, -.5, -.2).
    #[test]
    fn crop_golden_values() {
        let crop = Map::<Clip, Ray>::crop(DVec3::new(-0.5, -0.25, 0.1), DVec3::new(0.5, 0.75, 0.6)).0;
        let scale = DVec3::new(crop.x_axis.x, crop.y_axis.y, crop.z_axis.z);
        assert!((scale - DVec3::splat(2.0)).length() < 1e-15);
        assert!((crop.w_axis.truncate() - DVec3::new(0.0, -0.5, -0.2)).length() < 1e-15);
    }
}
