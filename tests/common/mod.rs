//! What property tests share: hostile inputs, and what holds of every frame whatever they are.
#![allow(
    dead_code,
    unreachable_pub,
    missing_docs,
    reason = "each test binary uses its own part; nothing here is a library"
)]

pub mod dice;
pub mod tally;

use antumbra::{
    Aabb, Camera, DepthRange, FitInput, Light, MapBudget, Object, Projection, Remix, Scene, ShadowFrame,
    ShadowTechnique,
};
use glam::{DMat3, DMat4, DQuat, DVec3};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

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
#[derive(Clone, Debug)]
pub struct Inputs {
    pub camera: Camera,
    pub travel: DVec3,
    pub casters: Aabb,
    pub receivers: Aabb,
    pub objects: Vec<Object>,
    pub visible: Option<DepthRange>,
    pub points: Vec<DVec3>,
    pub side: u32,
    pub layers: u32,
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
                objects: &self.objects,
                visible_depth: self.visible,
                visible_points: &self.points,
            },
            map: MapBudget { side: self.side, layers: self.layers, views: 8 },
            origin: self.origin,
            previous: None,
        }
    }

    /// The boxes that cast: those of the objects, where there are any; none for empty bounds.
    pub fn caster_boxes(&self) -> Vec<Aabb> {
        if self.objects.is_empty() {
            return [self.casters].into_iter().filter(|bounds| !bounds.is_empty()).collect();
        }
        self.objects.iter().filter(|object| object.casts).map(|object| object.bounds).collect()
    }
}

/// A point of a box, by three shares.
pub fn point_in(bounds: &Aabb, shares: [f64; 3]) -> DVec3 {
    let at = bounds.min + (bounds.max - bounds.min) * DVec3::from_array(shares);
    at.clamp(bounds.min, bounds.max)
}

/// Shares of a box or of a view volume: often 0 or 1.
pub fn shares() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(prop_oneof![2 => 0.0..=1.0_f64, 1 => Just(0.0), 1 => Just(1.0)])
}

/// The ray from a point towards the light inside a box, if any: distances (first, last) from the point.
pub fn towards_light(bounds: &Aabb, point: DVec3, travel: DVec3) -> Option<(f64, f64)> {
    let (mut first, mut last) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        if travel[axis] == 0.0 {
            if point[axis] < bounds.min[axis] || point[axis] > bounds.max[axis] {
                return None;
            }
            continue;
        }
        let a = (bounds.min[axis] - point[axis]) / -travel[axis];
        let b = (bounds.max[axis] - point[axis]) / -travel[axis];
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    (first <= last).then_some((first, last))
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

/// What light is made of: any direction; or off the view, or against it, by an angle from rounding to a right angle.
fn light() -> impl Strategy<Value = (DVec3, f64, f64)> {
    let off = prop_oneof![1 => Just(1e-15), 1 => (-17.0..0.0_f64).prop_map(|log| 10.0_f64.powf(log))];
    (direction(), prop_oneof![3 => Just(0.0), 1 => Just(1.0), 1 => Just(-1.0)], off)
}

/// Objects by shares of the casters' bounds, and whether they cast.
fn objects() -> impl Strategy<Value = Vec<([f64; 3], [f64; 3], bool)>> {
    prop_oneof![4 => Just(Vec::new()), 1 => prop::collection::vec((shares(), shares(), any::<bool>()), 1..5)]
}

/// Positions that the engine says are seen: none, few or many; in view, anywhere, and broken.
fn points() -> impl Strategy<Value = Vec<([f64; 3], f64)>> {
    let scale = prop_oneof![
        6 => Just(1.0),
        1 => prop::sample::select(vec![-1.0, 0.0, 1e-300, 1e9, 1e200, f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
    ];
    let point = (prop::array::uniform3(0.0..=1.0_f64), scale);
    prop_oneof![
        3 => Just(Vec::new()),
        1 => prop::collection::vec(point.clone(), 1..4),
        1 => prop::collection::vec(point, 20..60),
    ]
}

/// What a camera's rotation is off by: nothing, or as much scale and shear as it may be; and whether it is of f32.
fn skew() -> impl Strategy<Value = (DMat3, bool)> {
    let skew =
        prop::array::uniform9(-2.4e-4..=2.4e-4_f64).prop_map(|off| DMat3::IDENTITY + DMat3::from_cols_array(&off));
    (prop_oneof![3 => Just(DMat3::IDENTITY), 1 => skew], any::<bool>())
}

/// Everything but the boxes, which lie about what the camera sees.
#[derive(Clone, Debug)]
struct Stage {
    camera: Camera,
    travel: DVec3,
    visible: Option<DepthRange>,
    points: Vec<DVec3>,
    side: u32,
    /// 0: the world's origin; 1: the eye; else an offset from the receivers.
    origin: (u8, DVec3),
    /// The middle of the receivers, roughly.
    focus: DVec3,
}

fn stage() -> impl Strategy<Value = Stage> {
    let place = prop_oneof![3 => Just(0.0), 1 => (1.0..7.0_f64).prop_map(|log| 10.0_f64.powf(log))];
    let visible = prop_oneof![3 => Just(None), 1 => (0.0..10.0_f64, 0.0..1e4_f64).prop_map(Some)];
    // Render space around the world's origin, the eye, or somewhere near the scene.
    let offset = (direction(), -3.0..5.0_f64).prop_map(|(to, log)| to * 10.0_f64.powf(log));
    let focus = prop::array::uniform3(0.0..1.0_f64);
    let rest = ((0..3_u8, offset), focus, points(), skew());
    (place, (direction(), direction()), light(), projection(), visible, 0..15_u32, rest).prop_map(
        |(distance, (to, view), (light, along, off), projection, visible, log_side, (origin, focus, points, skew))| {
            let eye = to * distance;
            let rotation = DMat3::from_quat(DQuat::from_rotation_arc(DVec3::NEG_Z, view)) * skew.0;
            let rotation = if skew.1 { rotation.as_mat3().as_dmat3() } else { rotation };
            let world_from_view = DMat4::from_mat3_translation(rotation, eye);
            let camera = Camera { projection, ..Camera::perspective(world_from_view, 1.0, 1.0, 1.0, 2.0) };
            let travel = if along == 0.0 { light } else { (view * along + light * off).normalize_or(view) };
            let points = points.into_iter().map(|(shares, scale)| view_point(&camera, shares) * scale).collect();
            let visible = visible.map(|(near, length)| DepthRange { near, far: near + length });
            let focus = view_point(&camera, focus);
            Stage { camera, travel, visible, points, side: 1 << log_side, origin, focus }
        },
    )
}

/// Worlds near and far, light along the view exactly or nearly, flat boxes and none, eyes inside casters, every lens
/// from 1° to 179°, depths over eight decades or without end, maps of 1 to 16384 texels.
pub fn inputs() -> impl Strategy<Value = Inputs> {
    let kind = prop_oneof![16 => Just(0_u8), 4 => Just(1), 1 => Just(2), 1 => Just(3)];
    (stage(), kind).prop_flat_map(|(stage, kind)| {
        (bounds(stage.focus), size(), Just(stage), objects()).prop_flat_map(
            move |(receivers, distance, stage, objects)| {
                let above = receivers.centre() - stage.travel * distance;
                let origin = match stage.origin {
                    (0, _) => DVec3::ZERO,
                    (1, _) => stage.camera.eye(),
                    (_, offset) => receivers.centre() + offset,
                };
                (bounds(above), Just((stage, objects))).prop_map(move |(casters, (stage, objects))| {
                    let eye = stage.camera.eye();
                    let casters = match kind {
                        1 => casters.union(Aabb::new(eye - 0.01, eye + 0.01)),
                        2 => Aabb::EMPTY,
                        _ => casters,
                    };
                    let within = |(one, other, casts): ([f64; 3], [f64; 3], bool)| {
                        let (one, other) = (point_in(&casters, one), point_in(&casters, other));
                        Object { bounds: Aabb::new(one.min(other), one.max(other)), casts }
                    };
                    Inputs {
                        camera: stage.camera,
                        travel: stage.travel,
                        casters,
                        receivers: if kind == 3 { Aabb::EMPTY } else { receivers },
                        objects: if kind == 2 { Vec::new() } else { objects.into_iter().map(within).collect() },
                        visible: stage.visible,
                        points: stage.points,
                        side: stage.side,
                        layers: 8,
                        origin,
                    }
                })
            },
        )
    })
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

/// The receiver at some shares of the view, or, if `anywhere`, of the receivers' bounds, which are not empty.
pub fn receiver(inputs: &Inputs, shares: [f64; 3], anywhere: bool) -> DVec3 {
    if anywhere {
        point_in(&inputs.receivers, shares)
    } else {
        view_point(&inputs.camera, shares).clamp(inputs.receivers.min, inputs.receivers.max)
    }
}

/// The caster at a share of a receiver's ray to the light inside the first box that it meets, if any.
pub fn caster(inputs: &Inputs, receiver: DVec3, along: f64) -> Option<DVec3> {
    inputs.caster_boxes().iter().find_map(|bounds| {
        let (first, last) = towards_light(bounds, receiver, inputs.travel)?;
        let caster = receiver - inputs.travel * (first + along * (last - first));
        Some(caster.clamp(bounds.min, bounds.max))
    })
}

/// Whether no number of a frame is NaN or infinite, or less than it may be.
pub fn all_finite(frame: &ShadowFrame) -> bool {
    let uniforms: &[f32] = bytemuck::cast_slice(&frame.uniforms.views);
    uniforms.iter().all(|value| value.is_finite())
        && frame.predicted.error.is_finite()
        && frame.views.iter().all(|view| {
            view.clip_from_render.is_finite()
                && view.depth_from_render.is_finite()
                && view.texel.world[0] > 0.0
                && view.texel.world[1].is_finite()
                && view.texel.pixels.max.is_finite()
                && view.warp_strength.is_finite()
                && view.warp_strength >= 0.0
                && view.domain.iter().all(|depth| depth.is_finite())
                && view.cull.planes().iter().all(|plane| plane.is_finite())
        })
}

/// Everything is finite, equal inputs give equal bits, and no view means a reason.
pub fn sound(remix: Remix, inputs: &Inputs) -> Result<ShadowFrame, TestCaseError> {
    sound_after(remix, inputs, None)
}

/// The same, after any frame.
pub fn sound_after(
    remix: Remix,
    inputs: &Inputs,
    previous: Option<&ShadowFrame>,
) -> Result<ShadowFrame, TestCaseError> {
    let input = FitInput { previous, ..inputs.fit_input() };
    let frame = remix.fit(&input).unwrap();
    prop_assert!(all_finite(&frame), "{:?}: {:?}", remix.warp, frame);
    let again = remix.fit(&input).unwrap();
    prop_assert_eq!(bytemuck::bytes_of(&frame.uniforms), bytemuck::bytes_of(&again.uniforms));
    prop_assert_eq!(&frame, &again);
    prop_assert!(!frame.views.is_empty() || !frame.left_out.is_empty());
    Ok(frame)
}
