//! Depth along the light: from the first caster to the last receiver.

use glam::{DVec2, DVec3};

use crate::frame::CullVolume;
use crate::light_space::LightSpace;
use crate::scene::{Aabb, Scene};

/// Smallest and largest depth along the light that a view must hold, world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthAlongLight {
    /// Depth of the first caster, or of the first receiver if that is nearer.
    pub(crate) near: f64,
    /// Depth of the last receiver.
    pub(crate) far: f64,
}

impl DepthAlongLight {
    /// Over the receivers `vertices`, and over the casters that `cull` (the prism of the view's window) lets pass.
    ///
    /// O(objects). Without objects the casters' bounds serve, cut to the window.
    pub(crate) fn of(light: &LightSpace, vertices: &[DVec3], scene: &Scene, cull: &CullVolume) -> Self {
        let depth = |position: DVec3| light.travel().dot(position);
        let (mut near, far) = vertices
            .iter()
            .map(|vertex| depth(*vertex))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), depth| (near.min(depth), far.max(depth)));
        let first = |bounds: &Aabb| {
            let bounds = Aabb::new(bounds.min - cull.origin, bounds.max - cull.origin);
            depth(bounds.centre()) - light.travel().abs().dot(bounds.half_size())
        };
        if scene.objects.is_empty() {
            return Self { near: near.min(first(&scene.casters)), far };
        }
        for object in scene.objects.iter().filter(|object| object.casts && cull.may_cast(&object.bounds)) {
            near = near.min(first(&object.bounds));
        }
        Self { near, far }
    }

    /// Widened about its middle to at least `least`.
    pub(crate) fn at_least(self, least: f64) -> Self {
        let lack = (least - (self.far - self.near)).max(0.0) * 0.5;
        Self { near: self.near - lack, far: self.far + lack }
    }
}

/// The least extent, world units, that f32 positions as far out as `reach` can tell apart: 16 of their steps. Narrower
/// maps would resolve rounding; wider ones would cost a small body texels.
pub(crate) fn least_extent(vertices: &[DVec3], window_centre: DVec2) -> f64 {
    let reach =
        vertices.iter().fold(window_centre.abs().max_element(), |reach, vertex| reach.max(vertex.abs().max_element()));
    (16.0 * f64::from(f32::EPSILON) * reach).max(f64::from(f32::MIN_POSITIVE).sqrt())
}
