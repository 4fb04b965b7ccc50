//! Hostile inputs, shared by the property tests.
#![allow(
    dead_code,
    unreachable_pub,
    missing_docs,
    reason = "each test binary uses its own part; nothing here is a library"
)]

use antumbra::{Aabb, Camera, DepthRange, FitInput, Light, MapBudget, Projection, Scene};
use glam::{DMat4, DQuat, DVec3};
use proptest::prelude::*;

/// A direction that is often along an axis, exactly or a few ulps off.
pub fn direction() -> impl Strategy<Value = DVec3> {
    let free = prop::array::uniform3(-1.0..1.0_f64).prop_filter_map("zero", |v| DVec3::from_array(v).try_normalize());
    let axis = (0..3_usize, any::<bool>(), -320.0..-1.0_f64, prop::array::uniform3(-1.0..1.0_f64)).prop_map(
        |(axis, negative, log, tilt)| {
            let mut main = DVec3::ZERO;
            main[axis] = if negative { -1.0 } else { 1.0 };
            (main + DVec3::from_array(tilt) * 10.0_f64.powf(log)).normalize()
        },
    );
    prop_oneof![2 => free, 1 => axis]
}

/// A size between 1e-3 and 1e5, or zero (flat).
fn size() -> impl Strategy<Value = f64> {
    prop_oneof![4 => (-3.0..5.0_f64).prop_map(|log| 10.0_f64.powf(log)), 1 => Just(0.0)]
}

/// A box around a point near the origin or far out; often flat, sometimes a point.
fn bounds(centre: DVec3) -> impl Strategy<Value = Aabb> {
    let distance = prop_oneof![2 => Just(0.0), 1 => size()];
    (prop::array::uniform3(-1.0..1.0_f64), prop::array::uniform3(size()), distance).prop_map(
        move |(shift, half, distance)| {
            let (middle, half) = (centre + DVec3::from_array(shift) * distance, DVec3::from_array(half));
            Aabb::new(middle - half, middle + half)
        },
    )
}

/// Everything a fit reads, without borrowed parts.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    pub camera: Camera,
    pub travel: DVec3,
    pub casters: Aabb,
    pub receivers: Aabb,
    pub visible: Option<DepthRange>,
    pub side: u32,
    pub origin: DVec3,
}

impl Inputs {
    pub fn fit_input(&self) -> FitInput<'_> {
        FitInput {
            camera: self.camera,
            light: Light::Directional { travel: self.travel },
            scene: Scene {
                casters: self.casters,
                receivers: self.receivers,
                objects: &[],
                visible_depth: self.visible,
                visible_points: &[],
            },
            map: MapBudget::one(self.side),
            origin: self.origin,
            previous: None,
        }
    }
}

fn projection() -> impl Strategy<Value = Projection> {
    let depths = (-3.0..2.0_f64, 0.01..8.0_f64, any::<bool>());
    let perspective = (depths.clone(), 1.0..179.0_f64, 0.2..4.0_f64, -0.9..0.9_f64).prop_map(
        |((near, ratio, infinite), fov, aspect, shift)| {
            let near = 10.0_f64.powf(near);
            let far = if infinite { f64::INFINITY } else { near * 10.0_f64.powf(ratio) };
            let up = (0.5 * fov.to_radians()).tan();
            let side = up * aspect;
            Projection::Perspective {
                left: side * (shift - 1.0),
                right: side * (shift + 1.0),
                down: -up,
                up,
                near,
                far,
            }
        },
    );
    let orthographic = (depths, 0.01..1e4_f64, 0.2..4.0_f64).prop_map(|((near, ratio, _), up, aspect)| {
        let near = 10.0_f64.powf(near) - 5.0;
        let far = near + 10.0_f64.powf(ratio);
        Projection::Orthographic { left: -up * aspect, right: up * aspect, down: -up, up, near, far }
    });
    prop_oneof![4 => perspective, 1 => orthographic]
}

/// Worlds near and far, light along the view exactly or nearly, flat boxes, every lens from 1° to 179°, depths over
/// eight decades or without end, maps of 1 to 16384 texels.
pub fn inputs() -> impl Strategy<Value = Inputs> {
    let place = prop_oneof![3 => Just(0.0), 1 => (1.0..7.0_f64).prop_map(|log| 10.0_f64.powf(log))];
    let light = prop_oneof![3 => direction().prop_map(|d| (d, 0.0)), 1 => (direction(), Just(1.0)), 1 => (direction(), Just(-1.0))];
    let visible = prop_oneof![3 => Just(None), 1 => (0.0..10.0_f64, 0.0..1e4_f64).prop_map(Some)];
    // Render space around the world's origin, the eye, or somewhere near the scene.
    let offset = (direction(), -3.0..5.0_f64).prop_map(|(to, log)| to * 10.0_f64.powf(log));
    let origin = (0..3_u8, offset);
    let focus = (0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64);
    (place, (direction(), direction()), light, projection(), visible, 0..15_u32, origin, focus).prop_flat_map(
        |(distance, (to, view), (light, along), projection, visible, log_side, (place_of_origin, offset), focus)| {
            let eye = to * distance;
            let rotation = DQuat::from_rotation_arc(DVec3::NEG_Z, view);
            let camera = Camera {
                projection,
                ..Camera::perspective(DMat4::from_rotation_translation(rotation, eye), 1.0, 1.0, 1.0, 2.0)
            };
            let travel = if along == 0.0 { light } else { (view * along + light * 1e-15).normalize() };
            let visible = visible.map(|(near, length)| DepthRange { near, far: near + length });
            let focus = view_point(&camera, [focus.0, focus.1, focus.2]);
            (bounds(focus), size()).prop_flat_map(move |(receivers, distance)| {
                let above = receivers.centre() - travel * distance;
                let origin = match place_of_origin {
                    0 => DVec3::ZERO,
                    1 => eye,
                    _ => receivers.centre() + offset,
                };
                bounds(above).prop_map(move |casters| Inputs {
                    camera,
                    travel,
                    casters,
                    receivers,
                    visible,
                    side: 1 << log_side,
                    origin,
                })
            })
        },
    )
}

/// The point of the view volume at these shares of its width, height and (geometrically) depth; infinite depth ends
/// a hundred thousand near depths away.
pub fn view_point(camera: &Camera, shares: [f64; 3]) -> DVec3 {
    let (near, far) = camera.projection.depth_range();
    let [x, y, z] = shares;
    let (l, r, d, u, depth, spread) = match camera.projection {
        Projection::Perspective { left, right, down, up, .. } => {
            let depth = near * (far.min(near * 1e5) / near).powf(z);
            (left, right, down, up, depth, depth)
        }
        Projection::Orthographic { left, right, down, up, .. } => (left, right, down, up, near + (far - near) * z, 1.0),
    };
    camera.world_from_view.transform_point3(DVec3::new((l + (r - l) * x) * spread, (d + (u - d) * y) * spread, -depth))
}

/// Whether a world position is in view.
pub fn in_view(inputs: &Inputs, position: DVec3) -> bool {
    let view = inputs.camera.world_from_view.inverse().transform_point3(position);
    let depth = -view.z;
    let (near, far) = inputs.camera.projection.depth_range();
    let (near, far) = inputs.visible.map_or((near, far), |visible| (near.max(visible.near), far.min(visible.far)));
    if !(depth >= near && depth <= far) {
        return false;
    }
    let (l, r, d, u, spread) = match inputs.camera.projection {
        Projection::Perspective { left, right, down, up, .. } => (left, right, down, up, depth),
        Projection::Orthographic { left, right, down, up, .. } => (left, right, down, up, 1.0),
    };
    view.x >= l * spread && view.x <= r * spread && view.y >= d * spread && view.y <= u * spread
}
