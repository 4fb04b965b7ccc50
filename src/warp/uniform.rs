//! Uniform maps: the rectangle across the light that holds a body (SSM, FSM).
//!
//! # References
//! - Williams, *Casting curved shadows on curved surfaces*, 1978 (the standard shadow map).
//! - Brabec, Annen & Seidel, *Practical shadow mapping*, 2002 (focusing it on what is visible).
//! - `MATH.md` section 0, κ = 0; section 4, crop.

use glam::{DVec2, DVec3};

use crate::light_space::LightSpace;
use crate::math::convex::MAX_VERTICES;
use crate::math::rectangle::least_area_axis;

/// The extent of a map across the light: a rectangle in the (p, q) of its own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// The frame whose axes are the sides of the map.
    pub(crate) light: LightSpace,
    /// Smallest (p, q) that must be inside.
    pub(crate) low: DVec2,
    /// Largest (p, q) that must be inside.
    pub(crate) high: DVec2,
}

impl Window {
    /// Around `vertices`, in a frame that is given.
    pub(crate) fn around(light: LightSpace, vertices: &[DVec3]) -> Self {
        let (low, high) = vertices.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), vertex| {
            let across = light.ray(*vertex).truncate();
            (low.min(across), high.max(across))
        });
        Self { light, low, high }
    }

    /// Around `vertices`, in the frame in which it is smallest (least area).
    pub(crate) fn least_area(light: LightSpace, vertices: &[DVec3]) -> Self {
        let across = vertices.iter().map(|vertex| light.ray(*vertex).truncate());
        let axis = least_area_axis::<MAX_VERTICES>(across).unwrap_or(DVec2::X);
        Self::around(light.turned(axis), vertices)
    }

    /// Width and height, world units.
    pub(crate) fn size(&self) -> DVec2 {
        self.high - self.low
    }

    /// Width times height.
    pub(crate) fn area(&self) -> f64 {
        self.size().element_product()
    }

    /// Grown by `margin` on every side.
    pub(crate) fn grown(self, margin: f64) -> Self {
        Self { low: self.low - margin, high: self.high + margin, ..self }
    }
}
