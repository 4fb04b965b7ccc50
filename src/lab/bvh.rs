//! Ray tracing of a scene: a bounding-volume hierarchy in f32, triangles in f64.
//!
//! Nothing here knows of shadow maps; this is what they are judged by. Triangles are two-sided, edges belong to both
//! neighbours (no ray slips between two triangles), and holes of cut-out triangles let rays through.
//!
//! # References
//! - Woop, Benthin, Wald: *Watertight Ray/Triangle Intersection*, JCGT 2(1), 2013 (the shear and the edge functions).
//! - Ylitie, Karras, Laine: *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs*, HPG 2017
//!   (the hierarchy, from the crate `obvhs`).

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray as NodeRay, RayHit};

use super::scene::SceneModel;

/// Growth of every node's box, as a part of the scene's bounding sphere's radius (the f32 unit of the hierarchy).
///
/// A slab test in f32 inside the unit sphere is off by at most a few 2⁻²⁴ · 2; this is about thirty of them. Less
/// loses hits on flat boxes, much more visits boxes in vain.
const BOX_MARGIN: f32 = 4e-6;

/// How far ahead of the ray's start the hierarchy starts looking, in the same unit: `obvhs` passes over boxes that end
/// within 10⁻⁴ of the start. Less loses hits next to the start, more visits boxes behind it.
const LEAD: f64 = 1e-3;

/// A ray `origin + t · direction`, `t_min < t < t_max`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Start of the ray in world space.
    pub origin: DVec3,
    /// Direction in world space, of any length but zero: `t` counts in multiples of it.
    pub direction: DVec3,
    /// Least parameter of a hit (exclusive).
    pub t_min: f64,
    /// Greatest parameter of a hit (exclusive); may be infinite.
    pub t_max: f64,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index into [`SceneModel::triangles`].
    pub triangle: u32,
    /// Parameter of the ray, in multiples of its direction.
    pub t: f64,
    /// Weights of the triangle's three corners; they add up to 1.
    pub weights: DVec3,
}

/// The hierarchy over one scene.
pub struct Bvh<'s> {
    scene: &'s SceneModel,
    nodes: CwBvh,
    /// Corners relative to `centre`, in the order of the hierarchy's leaves.
    corners: Vec<[DVec3; 3]>,
    centre: DVec3,
    /// Radius of a sphere around `centre` that holds the scene; positive.
    radius: f64,
}

impl<'s> Bvh<'s> {
    /// Builds the hierarchy, in O(n log n) for n triangles.
    ///
    /// Panics when a triangle's index is out of range, as every reader of [`SceneModel`] does; loaders check that.
    #[must_use]
    pub fn new(scene: &'s SceneModel) -> Self {
        // Centre the scene and find the sphere around it.
        let (least, greatest) = scene.bounds().unwrap_or_default();
        let centre = (least + greatest) * 0.5;
        let radius = ((greatest - least).length() * 0.5).max(f64::MIN_POSITIVE.sqrt());
        let local: Vec<[DVec3; 3]> =
            (0..scene.triangles.len()).map(|triangle| scene.corners(triangle).map(|corner| corner - centre)).collect();
        // Box the triangles in units of the radius, with a margin for f32.
        let boxes: Vec<Aabb> = local.iter().map(|corners| margin_box(corners, radius)).collect();
        let nodes = if boxes.is_empty() {
            CwBvh::default()
        } else {
            let params = BvhBuildParams { max_prims_per_leaf: 3, ..BvhBuildParams::medium_build() };
            build_cwbvh(&boxes, params, &mut Duration::default())
        };
        // Lay the corners out as the leaves ask for them.
        let corners = nodes.primitive_indices.iter().map(|&triangle| local[triangle as usize]).collect();
        Self { scene, nodes, corners, centre, radius }
    }

    /// The scene the hierarchy was built over.
    #[must_use]
    pub fn scene(&self) -> &'s SceneModel {
        self.scene
    }

    /// Radius of the sphere that holds the scene, in world units; the scale of tolerances.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Finds the hit with the least `t`; of several at one `t`, the one on the triangle with the least index.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let (node_ray, frame) = self.prepare(ray)?;
        let mut best: Option<Hit> = None;
        self.nodes.ray_traverse(node_ray, &mut RayHit::none(), |_, leaf| {
            let Some(hit) = self.intersect(&frame, ray, leaf) else { return f32::INFINITY };
            let better = best.is_none_or(|best| (hit.t, hit.triangle) < (best.t, best.triangle));
            if !better || !self.scene.is_solid(hit.triangle as usize, hit.weights) {
                return f32::INFINITY;
            }
            best = Some(hit);
            frame.node_t(hit.t)
        });
        best
    }

    /// Tells whether anything solid lies on the ray, except on the triangle `skip`.
    #[must_use]
    pub fn is_blocked(&self, ray: &Ray, skip: Option<u32>) -> bool {
        let Some((node_ray, frame)) = self.prepare(ray) else { return false };
        !self.nodes.ray_traverse_miss(node_ray, |_, leaf| {
            let hit = self.intersect(&frame, ray, leaf).filter(|hit| Some(hit.triangle) != skip);
            let solid = hit.is_some_and(|hit| self.scene.is_solid(hit.triangle as usize, hit.weights));
            if solid { f32::NEG_INFINITY } else { f32::INFINITY }
        })
    }

    /// Narrows the ray to the hierarchy's f32 frame; `None` when it cannot meet the scene.
    fn prepare(&self, ray: &Ray) -> Option<(NodeRay, RayFrame)> {
        let has_range = ray.t_min < ray.t_max;
        if self.corners.is_empty() || !has_range || !ray.origin.is_finite() {
            return None;
        }
        let length = ray.direction.length();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        let origin = ray.origin - self.centre;
        let unit = ray.direction / length;
        // Start inside the scene's sphere, however far the eye: f32 must not lose the position along the way.
        let nearest = -origin.dot(unit);
        if (origin + unit * nearest).length() > self.radius * (1.0 + LEAD) {
            return None;
        }
        let start = (ray.t_min * length).max(nearest - self.radius) - LEAD * self.radius;
        if start > nearest + self.radius {
            return None;
        }
        // `obvhs` 0.4 takes -0 for negative in one place and for positive in another; adding 0 makes it +0.
        let narrow = |v: DVec3| v.as_vec3a() + Vec3A::ZERO;
        let node_origin = narrow((origin + unit * start) / self.radius);
        let frame = RayFrame::new(origin, ray.direction, start, length / self.radius);
        let end = if ray.t_max.is_finite() { frame.node_t(ray.t_max) } else { f32::INFINITY };
        Some((NodeRay::new(node_origin, narrow(unit), 0.0, end), frame))
    }

    /// Intersects the ray with the triangle at a place of the leaves' order, whatever its alpha mask says.
    fn intersect(&self, frame: &RayFrame, ray: &Ray, leaf: usize) -> Option<Hit> {
        let (t, weights) = frame.intersect(&self.corners[leaf])?;
        let triangle = self.nodes.primitive_indices[leaf];
        (t > ray.t_min && t < ray.t_max).then_some(Hit { triangle, t, weights })
    }
}

/// The shear that turns the ray into the third axis (Woop et al. section 3), in f64.
struct RayFrame {
    origin: DVec3,
    /// The axes, the one of the greatest component of the direction last.
    axes: [usize; 3],
    /// Sx, Sy, Sz of the paper.
    shear: DVec3,
    /// Hierarchy units per unit of `t`.
    node_per_t: f64,
    /// `start` in hierarchy units.
    node_start: f64,
}

impl RayFrame {
    fn new(origin: DVec3, direction: DVec3, start: f64, node_per_t: f64) -> Self {
        let size = direction.abs();
        let z = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let d = axes.map(|axis| direction[axis]);
        let shear = DVec3::new(d[0] / d[2], d[1] / d[2], 1.0 / d[2]);
        let node_start = start * node_per_t / direction.length();
        Self { origin, axes, shear, node_per_t, node_start }
    }

    /// Rounds a parameter up into the hierarchy's f32 units, so that no box with a nearer hit is passed over.
    fn node_t(&self, t: f64) -> f32 {
        let exact = t * self.node_per_t - self.node_start;
        exact as f32 + BOX_MARGIN
    }

    /// Returns `t` and the corners' weights where the ray's line meets the triangle, edges included.
    fn intersect(&self, corners: &[DVec3; 3]) -> Option<(f64, DVec3)> {
        let [kx, ky, kz] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let v = corner - self.origin;
            DVec3::new(v[kx] - self.shear.x * v[kz], v[ky] - self.shear.y * v[kz], self.shear.z * v[kz])
        });
        // Scaled weights by edge functions: both neighbours of an edge compute the same product pair.
        let u = c.x * b.y - c.y * b.x;
        let v = a.x * c.y - a.y * c.x;
        let w = b.x * a.y - b.y * a.x;
        let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
        let determinant = u + v + w;
        if !inside || determinant == 0.0 {
            return None;
        }
        let weights = DVec3::new(u, v, w) / determinant;
        Some((weights.dot(DVec3::new(a.z, b.z, c.z)), weights))
    }
}

/// Boxes a triangle in units of the radius, grown by the margin.
fn margin_box(corners: &[DVec3; 3], radius: f64) -> Aabb {
    let [a, b, c] = corners.map(|corner| (corner / radius).as_vec3a());
    let margin = Vec3A::splat(BOX_MARGIN);
    Aabb::new(a.min(b).min(c) - margin, a.max(b).max(c) + margin)
}
