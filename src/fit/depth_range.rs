//! Depth along the light: from the first caster to the last receiver.

use glam::{DVec2, DVec3};

use crate::frame::CullVolume;
use crate::light_space::LightSpace;
use crate::scene::{Aabb, Scene};
use crate::warp::window::Window;

/// Smallest and largest depth along the light that a view must hold, world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthAlongLight {
    /// Depth of the first caster, or of the first receiver if that is nearer.
    pub(crate) near: f64,
    /// Depth of the last receiver.
    pub(crate) far: f64,
}

impl DepthAlongLight {
    /// Over the receivers `vertices`, and over the casters that `cull` (the prism of `window`) lets pass: objects,
    /// where the scene lists any, else the casters' bounds; of each, the part that rays of the window can meet.
    ///
    /// `None` when no object can throw a shadow into the window. O(objects).
    pub(crate) fn of(window: &Window, vertices: &[DVec3], scene: &Scene, cull: &CullVolume) -> Option<Self> {
        let (light, corners) = (&window.light, window.corners());
        let depth = |position: DVec3| light.travel().dot(position);
        let first = |bounds: &Aabb| {
            let here = Aabb::new(bounds.min - cull.origin, bounds.max - cull.origin);
            let nearest = depth(here.centre()) - light.travel().abs().dot(here.half_size());
            corners.map_or(nearest, |corners| nearest.max(entry(light, &here, &corners)))
        };
        let mut near = f64::INFINITY;
        if scene.objects.is_empty() {
            near = first(&scene.casters);
        }
        for object in scene.objects.iter().filter(|object| object.casts && cull.may_cast(&object.bounds)) {
            near = near.min(first(&object.bounds));
        }
        if near == f64::INFINITY {
            return None;
        }
        let mut far = f64::NEG_INFINITY;
        for vertex in vertices {
            near = near.min(depth(*vertex));
            far = far.max(depth(*vertex));
        }
        Some(Self { near, far })
    }

    /// Over the whole scene: the same wherever the camera looks.
    pub(crate) fn of_scene(light: &LightSpace, scene: &Scene, origin: DVec3) -> Self {
        let ends = |bounds: &Aabb| {
            let middle = light.travel().dot(bounds.centre() - origin);
            let half = light.travel().abs().dot(bounds.half_size());
            [middle - half, middle + half]
        };
        let [casters, receivers] = [ends(&scene.casters), ends(&scene.receivers)];
        Self { near: casters[0].min(receivers[0]), far: receivers[1] }
    }

    /// Widened at both ends by what f32 loses of positions as far out as these depths and `margin`'s.
    pub(crate) fn widened(self, margin: f64) -> Self {
        let margin = margin.max(rounding(self.near.abs().max(self.far.abs()), DVec3::ZERO));
        Self { near: self.near - margin, far: self.far + margin }
    }
}

/// A lower bound of the depth at which rays of the window enter a box (render space): for each pair of faces that rays
/// do not run along, the least depth over the window at which they pass the first one; the largest of those.
fn entry(light: &LightSpace, bounds: &Aabb, corners: &[DVec2; 4]) -> f64 {
    let mut entry = f64::NEG_INFINITY;
    for axis in 0..3 {
        let travel = light.travel()[axis];
        if travel.abs() < LEAST_SLOPE {
            continue;
        }
        // Rays start where (p, q) puts them; of the window, the corner from which they reach the face soonest.
        let along = DVec2::new(light.p()[axis], light.q()[axis]) * travel.signum();
        let start = corners.iter().map(|corner| along.dot(*corner)).fold(f64::NEG_INFINITY, f64::max);
        let face = if travel > 0.0 { bounds.min[axis] } else { -bounds.max[axis] };
        entry = entry.max((face - start) / travel.abs());
    }
    entry
}

/// Slope below which the rays run along a pair of faces: the depth at which they enter would magnify rounding.
const LEAST_SLOPE: f64 = 1e-3;

/// Roundings of an f32 position on its way into a map: its own (½), the product with a matrix row (3 × ½), the matrix
/// entries (½ each): 4 half steps, taken as whole ones. Fewer can push the outermost vertex out of the map; more costs
/// texels only where positions are as coarse as texels.
const POSITION_ROUNDINGS: f64 = 4.0;

/// What f32 loses of coordinates as large as `reach`, and f64 of world coordinates as large as `origin`'s, world units.
/// Never zero, so that nothing divides by zero.
pub(crate) fn rounding(reach: f64, origin: DVec3) -> f64 {
    let narrowed = POSITION_ROUNDINGS * f64::from(f32::EPSILON) * reach;
    let world = WORLD_ROUNDINGS * f64::EPSILON * origin.abs().max_element();
    (narrowed + world).max(LEAST_MARGIN)
}

/// Roundings of a world position in f64 before `origin` is subtracted: its own, and those of whoever computed it (a
/// product and a sum on each of three axes). Fewer can miss a caster that stands exactly at a window's rim; more costs
/// texels only where f64 is as coarse as they are.
const WORLD_ROUNDINGS: f64 = 8.0;

/// A body that is one point at the origin of render space still gets a map, of this size in world units: its texels'
/// squares are far from f32's underflow.
const LEAST_MARGIN: f64 = 1e-12;

/// How far a map must reach beyond `vertices` so that f32 positions land inside it, world units.
pub(crate) fn rounding_margin(vertices: &[DVec3], origin: DVec3) -> f64 {
    rounding(vertices.iter().fold(0.0, |reach: f64, vertex| reach.max(vertex.abs().max_element())), origin)
}
