//! Matrices that know where they come from and where they go: composing them in the wrong order does not compile.

use core::marker::PhantomData;
use core::ops::Mul;

use glam::{DMat4, DVec4, Mat4, Vec4};

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

    /// From its rows.
    pub(crate) fn from_rows(rows: [DVec4; 4]) -> Self {
        Self::new(DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose())
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
