//! What has to be in the map: the receivers in view that something may shadow, and the casters that may shadow them.
//!
//! # References
//! - Scherzer, *Robust shadow maps for large environments*, section 4.1 and MATH.md section 2: body B and receivers
//!   LVS.
//! - Stamminger & Drettakis, *Perspective shadow maps*, H = M ∩ S ∩ L (MATH.md section 3).

use arrayvec::ArrayVec;
use glam::{DVec3, DVec4};

use crate::camera::Camera;
use crate::math::convex::{Convex, HalfSpace, MAX_VERTICES};
use crate::report::{LeftOut, Part, Why};
use crate::scene::{Aabb, DepthRange, Scene};

/// A convex body in render space that holds every receiver in view that a caster may shadow.
#[derive(Clone, Debug)]
pub(crate) struct FocusBody {
    /// As a polyhedron.
    convex: Convex,
    /// Its vertices, all finite, at least one.
    pub(crate) vertices: ArrayVec<DVec3, MAX_VERTICES>,
    /// The half-spaces that cut it out of the view frustum (or out of the receivers' bounds): it lies in all of them.
    pub(crate) walls: ArrayVec<HalfSpace, MAX_WALLS>,
    /// The eye depths it was cut to; all of them for a body of the scene.
    pub(crate) depth: DepthRange,
    /// What the body does without.
    pub(crate) left_out: ArrayVec<LeftOut, 2>,
}

/// Bounds are grown by this share of the largest coordinate that takes part (as seen from the origin of render space),
/// so that rounding in f64, a thousand times smaller, never empties a flat box. Smaller loses flat ground; larger costs
/// texels.
const BOUNDS_MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;

/// Most walls: a box (6), and the shadow of a box (9).
pub(crate) const MAX_WALLS: usize = 15;

impl FocusBody {
    /// The receivers of the whole scene that the casters' bounds can shadow, whoever looks: view-independent.
    pub(crate) fn of_scene(scene: &Scene, travel: DVec3, origin: DVec3) -> Result<Self, LeftOut> {
        nothing_in(scene)?;
        let receivers = grown(&scene.receivers, origin, 0.0);
        let depth = DepthRange { near: f64::NEG_INFINITY, far: f64::INFINITY };
        let mut body = Self::new(Convex::hexahedron(box_corners(&receivers)), depth);
        body.keep_shadowed(scene, travel, origin, 0.0)?;
        Ok(body)
    }

    /// The receivers in view: frustum ∩ receivers' bounds ∩ the shadow of the casters' bounds.
    pub(crate) fn of_view(camera: &Camera, scene: &Scene, travel: DVec3, origin: DVec3) -> Result<Self, LeftOut> {
        nothing_in(scene)?;
        // The frustum, between the depths that are visible.
        let DepthRange { near, far } = visible_depth(camera, scene)?;
        let mut body = Self::new(Convex::hexahedron(camera.corners(near, far, origin)), DepthRange { near, far });
        // Of it, what the receivers' bounds hold.
        let reach = (camera.eye() - origin).abs().max_element();
        let walls = box_planes(&grown(&scene.receivers, origin, reach));
        for plane in walls {
            body.convex.clip(plane);
        }
        if body.convex.is_empty() {
            return Err(LeftOut { part: Part::Light, why: Why::NoReceiversInView { near, far } });
        }
        // Of that, what something can shadow.
        let _ = body.walls.try_extend_from_slice(&walls); // never full: MAX_WALLS
        body.keep_shadowed(scene, travel, origin, reach)?;
        if (DepthRange { near, far }) != camera_depth(camera) {
            let _ = body.left_out.try_push(LeftOut { part: Part::Frustum, why: Why::NotVisible { near, far } });
        }
        Ok(body)
    }

    fn new(convex: Convex, depth: DepthRange) -> Self {
        Self { convex, vertices: ArrayVec::new(), walls: ArrayVec::new(), depth, left_out: ArrayVec::new() }
    }

    /// Its edges, by their ends.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> {
        self.convex.edges()
    }

    /// Nearest and farthest eye depth of its vertices.
    pub(crate) fn seen_depth(&self, camera: &Camera, origin: DVec3) -> DepthRange {
        let range = DepthRange { near: f64::INFINITY, far: f64::NEG_INFINITY };
        let grown = |DepthRange { near, far }: DepthRange, depth: f64| DepthRange {
            near: near.min(depth),
            far: far.max(depth),
        };
        let (eye, forward) = (camera.eye() - origin, depth_from_view(camera));
        let depths = self.vertices.iter().map(|vertex| (*vertex - eye).dot(forward));
        let DepthRange { near, far } = depths.fold(range, grown);
        // Rounding may put vertices before the eye, and all of them beyond either end.
        let within = |depth: f64| depth.max(self.depth.near).min(self.depth.far);
        DepthRange { near: within(near), far: within(far) }
    }

    /// The part of a body in view between two eye depths; `None` where there is nothing.
    pub(crate) fn slice(&self, camera: &Camera, depth: DepthRange, origin: DVec3) -> Option<Self> {
        let mut slice = Self::new(self.convex.clone(), depth);
        let forward = depth_from_view(camera);
        let eye = forward.dot(camera.eye() - origin);
        slice.convex.clip(forward.extend(-eye - depth.near));
        slice.convex.clip((-forward).extend(eye + depth.far));
        slice.vertices.extend(slice.convex.points());
        let _ = slice.walls.try_extend_from_slice(&self.walls); // as many as there are
        (!slice.vertices.is_empty()).then_some(slice)
    }

    /// Keeps what the shadow of the casters' bounds reaches.
    fn keep_shadowed(&mut self, scene: &Scene, travel: DVec3, origin: DVec3, reach: f64) -> Result<(), LeftOut> {
        let (casters, receivers) = (&scene.casters, &scene.receivers);
        // Receivers among the casters are all in their shadow.
        let among = casters.min.cmple(receivers.min).all() && casters.max.cmpge(receivers.max).all();
        if !among {
            let mut cut = false;
            for plane in shadow_planes(&grown(casters, origin, reach), travel) {
                cut |= self.convex.clip(plane);
                let _ = self.walls.try_push(plane); // never full: MAX_WALLS
            }
            if cut {
                self.left_out.push(LeftOut { part: Part::Receivers(0), why: Why::LitWithoutLookup });
            }
        }
        self.vertices.extend(self.convex.points());
        if self.vertices.is_empty() {
            return Err(LeftOut { part: Part::Light, why: Why::NothingCastsHere });
        }
        Ok(())
    }
}

fn nothing_in(scene: &Scene) -> Result<(), LeftOut> {
    if scene.receivers.is_empty() {
        return Err(LeftOut { part: Part::Light, why: Why::NoReceivers });
    }
    if scene.casters.is_empty() {
        return Err(LeftOut { part: Part::Light, why: Why::NoCasters });
    }
    Ok(())
}

/// The camera's own depth range.
fn camera_depth(camera: &Camera) -> DepthRange {
    let (near, far) = camera.projection.depth_range();
    DepthRange { near, far }
}

/// What the eye depth of a point grows by with its position: the row of the camera's inverse. The engine's own depths
/// are by that, and cameras are not quite rigid, by what f32 loses of them or by a scale.
fn depth_from_view(camera: &Camera) -> DVec3 {
    let [right, up, back] = [0, 1, 2].map(|axis| camera.world_from_view.col(axis).truncate());
    let across = right.cross(up);
    across / -across.dot(back)
}

/// The camera's depth range, cut to what the scene says is visible.
fn visible_depth(camera: &Camera, scene: &Scene) -> Result<DepthRange, LeftOut> {
    let DepthRange { near, far } = camera_depth(camera);
    let Some(visible) = scene.visible_depth else { return Ok(DepthRange { near, far }) };
    let cut = DepthRange { near: near.max(visible.near), far: far.min(visible.far) };
    if cut.near <= cut.far {
        return Ok(cut);
    }
    Err(LeftOut { part: Part::Light, why: Why::OutsideVisibleDepth { near: visible.near, far: visible.far } })
}

/// Bounds in render space, grown by the margin; `reach` is the largest coordinate of whatever they are cut with.
fn grown(bounds: &Aabb, origin: DVec3, reach: f64) -> Aabb {
    let (min, max) = (bounds.min - origin, bounds.max - origin);
    let margin = BOUNDS_MARGIN * min.abs().max(max.abs()).max_element().max(reach);
    Aabb { min: min - margin, max: max + margin }
}

fn box_corners(bounds: &Aabb) -> [DVec4; 8] {
    core::array::from_fn(|bits| {
        let pick = |bit: usize, low: f64, high: f64| if bits & bit == 0 { low } else { high };
        let (min, max) = (bounds.min, bounds.max);
        DVec4::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z), 1.0)
    })
}

fn box_planes(bounds: &Aabb) -> [HalfSpace; 6] {
    core::array::from_fn(|index| {
        let axis = index / 2;
        let mut normal = DVec3::ZERO;
        if index % 2 == 0 {
            normal[axis] = 1.0;
            normal.extend(-bounds.min[axis])
        } else {
            normal[axis] = -1.0;
            normal.extend(bounds.max[axis])
        }
    })
}

/// The shadow of a box, `{x : x − t·travel ∈ box for a t ≥ 0}`, as half-spaces: the faces where light enters, and the
/// planes along the light through the box's silhouette (which contain one axis each). At most 3 + 6.
fn shadow_planes(bounds: &Aabb, travel: DVec3) -> ArrayVec<HalfSpace, 9> {
    let mut planes = ArrayVec::new();
    for axis in 0..3 {
        let mut unit = DVec3::ZERO;
        unit[axis] = 1.0;
        // The face where light enters; a face along the light is found below, as a silhouette plane.
        if travel[axis] > 0.0 {
            planes.push(unit.extend(-bounds.min[axis]));
        } else if travel[axis] < 0.0 {
            planes.push((-unit).extend(bounds.max[axis]));
        }
        // The two planes along the light and this axis.
        if let Some(normal) = travel.cross(unit).try_normalize() {
            let centre = normal.dot(bounds.centre());
            let half = normal.abs().dot(bounds.half_size());
            planes.push(normal.extend(half - centre));
            planes.push((-normal).extend(half + centre));
        }
    }
    planes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// The shadow of a box against its definition: walk from the point towards the light and look for the box.
        #[test]
        fn the_shadow_of_a_box(
            point in prop::array::uniform3(-3.0..3.0_f64),
            direction in prop::array::uniform3(prop_oneof![-1.0..1.0_f64, Just(0.0)]),
        ) {
            let Some(travel) = DVec3::from_array(direction).try_normalize() else { return Ok(()) };
            let bounds = Aabb::new(DVec3::new(-1.0, -0.5, -0.2), DVec3::new(0.5, 0.75, 1.0));
            let point = DVec3::from_array(point);
            let margin = shadow_planes(&bounds, travel).iter().map(|p| p.dot(point.extend(1.0))).fold(f64::INFINITY, f64::min);
            // Slab test of the ray towards the light.
            let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
            for axis in 0..3 {
                if travel[axis] == 0.0 {
                    if point[axis] < bounds.min[axis] || point[axis] > bounds.max[axis] { leave = -1.0; }
                    continue;
                }
                let a = (bounds.min[axis] - point[axis]) / -travel[axis];
                let b = (bounds.max[axis] - point[axis]) / -travel[axis];
                enter = enter.max(a.min(b));
                leave = leave.min(a.max(b));
            }
            if margin.abs() > 1e-9 && (leave - enter).abs() > 1e-6 {
                prop_assert_eq!(margin > 0.0, leave >= enter, "margin {} enter {} leave {}", margin, enter, leave);
            }
        }
    }
}
