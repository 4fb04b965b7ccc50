//! Depth along the light: from the first caster to the last receiver.

use glam::DVec3;

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

    /// Widened at both ends by what f32 loses of positions as far out as these depths and `margin`'s.
    pub(crate) fn widened(self, margin: f64) -> Self {
        let margin = margin.max(rounding(self.near.abs().max(self.far.abs())));
        Self { near: self.near - margin, far: self.far + margin }
    }
}

/// Roundings of an f32 position on its way into a map: its own (½), the product with a matrix row (3 × ½), the matrix
/// entries (½ each): 4 half steps, taken as whole ones. Fewer can push the outermost vertex out of the map; more costs
/// texels only where positions are as coarse as texels.
const POSITION_ROUNDINGS: f64 = 4.0;

/// What f32 loses of coordinates as large as `reach`, world units. Never zero, so that nothing divides by zero.
fn rounding(reach: f64) -> f64 {
    (POSITION_ROUNDINGS * f64::from(f32::EPSILON) * reach).max(LEAST_MARGIN)
}

/// A body that is one point at the origin of render space still gets a map, of this size in world units: its texels'
/// squares are far from f32's underflow.
const LEAST_MARGIN: f64 = 1e-12;

/// How far a map must reach beyond `vertices` so that f32 positions land inside it, world units.
pub(crate) fn rounding_margin(vertices: &[DVec3]) -> f64 {
    rounding(vertices.iter().fold(0.0, |reach: f64, vertex| reach.max(vertex.abs().max_element())))
}
