//! No plane shadows itself: planes at any slope, rasterised as a GPU does, looked up through the Rust twins, near the origin of
//! render space and far from it.

mod common;

use antumbra::encoding::depth::{DepthMap, antumbra_caster, antumbra_visible};
use antumbra::{
    Aabb, Camera, Encoding, FitInput, Light, MapBudget, Pcf, Remix, Scene, ShadowFrame, ShadowTechnique, techniques,
};
use common::direction;
use glam::{DVec2, DVec3, UVec2, Vec3};
use proptest::prelude::*;

/// A triangle in render space, as a vertex buffer holds it.
type Corners = [Vec3; 3];

/// Draws one triangle as GPUs do: f32 matrix, vertices on 1/256 of a texel, depth at texel centres; the rest cleared.
fn rasterised(frame: &ShadowFrame, corners: &Corners) -> Vec<f32> {
    let (view, side) = (&frame.views[0], frame.map.side);
    let viewport = view.viewport.as_vec4().as_dvec4();
    let placed = corners.map(|corner| {
        let clip = antumbra_caster(view.clip_from_render, corner).as_dvec4();
        let unit = DVec2::new(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
        let at = DVec2::new(viewport.x + unit.x * viewport.z, viewport.y + unit.y * viewport.w);
        ((at * 256.0).round() / 256.0).extend(clip.z)
    });
    let (first, second) = (placed[1] - placed[0], placed[2] - placed[0]);
    let area = first.x * second.y - first.y * second.x;
    let ring = view.viewport.x;
    let depth_at = |x: u32, y: u32| {
        let (dx, dy) = (f64::from(x) + 0.5 - placed[0].x, f64::from(y) + 0.5 - placed[0].y);
        let (a, b) = ((dx * second.y - dy * second.x) / area, (first.x * dy - first.y * dx) / area);
        let depth = (placed[0].z + a * first.z + b * second.z) as f32;
        let drawn = x >= ring && y >= ring && x < side - ring && y < side - ring;
        let inside = drawn && a >= 0.0 && b >= 0.0 && a + b <= 1.0 && (0.0..=1.0).contains(&depth);
        if inside { depth } else { 1.0 }
    };
    (0..side * side).map(|texel| depth_at(texel % side, texel / side)).collect()
}

/// A plane's triangle through `middle`, much larger than the map, and its normal after narrowing, on the lit side.
fn triangle(middle: DVec3, normal: DVec3, size: f64) -> Option<(Corners, Vec3)> {
    let across = normal.any_orthonormal_vector();
    let along = normal.cross(across);
    let corner = |angle: f64| (middle + (across * angle.cos() + along * angle.sin()) * size * 4.0).as_vec3();
    let corners = [0.0, 2.1, 4.2].map(corner);
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let narrowed = (b - a).cross(c - a).try_normalize()?;
    Some((corners, (narrowed * narrowed.dot(normal).signum()).as_vec3()))
}

/// Visible means lit by more than all but rounding of an average.
const LIT: f32 = 0.999;

proptest! {
    #![proptest_config(ProptestConfig { cases: 4_000, ..ProptestConfig::default() })]

    #[test]
    fn no_plane_shadows_itself(
        travel in direction(), tilt in direction(), log_cosine in -4.0..0.0_f64, log_size in -1.0..3.0_f64, away in direction(),
        log_distance in prop_oneof![Just(-9.0), 0.0..6.0_f64], filter in 0..4_usize, log_side in 6..9_u32,
        points in prop::collection::vec(prop::array::uniform2(0.0..1.0_f64), 100),
    ) {
        // A scene somewhere in render space, and a plane through it at a slope to the light.
        let (size, filter) = (10.0_f64.powf(log_size), Pcf::ALL[filter]);
        let middle = away * 10.0_f64.powf(log_distance);
        let bounds = Aabb::new(middle - size, middle + size);
        let cosine = 10.0_f64.powf(log_cosine);
        let Some(flat) = (tilt - travel * tilt.dot(travel)).try_normalize() else { return Ok(()) };
        let normal = (flat * (1.0 - cosine * cosine).sqrt() - travel * cosine).normalize();
        let Some((corners, normal)) = triangle(middle, normal, size) else { return Ok(()) };
        let camera = Camera::perspective(Camera::look_at(middle + DVec3::new(0.3, 0.5, 2.9) * size, middle, DVec3::Y), 1.2, 1.5, 0.01 * size, 10.0 * size);
        let remix = Remix { encoding: Encoding::Depth(filter), ..techniques::ssm() };
        let input = FitInput {
            camera,
            light: Light::Directional { travel },
            scene: Scene::within(bounds),
            map: MapBudget::one(1 << log_side),
            origin: DVec3::ZERO,
            previous: None,
        };
        let frame = remix.fit(&input).unwrap();
        // Draw it, and look points of it up.
        let depth = rasterised(&frame, &corners);
        let map = DepthMap { size: UVec2::splat(frame.map.side), depth: &depth };
        for [a, b] in points {
            let [a, b] = if a + b > 1.0 { [1.0 - a, 1.0 - b] } else { [a, b] };
            let [p, q, r] = corners.map(Vec3::as_dvec3);
            let point = p + (q - p) * a + (r - p) * b;
            if point.cmplt(bounds.min).any() || point.cmpgt(bounds.max).any() {
                continue;
            }
            let lit = antumbra_visible(frame.wgsl, &frame.uniforms.views[0], &map, point.as_vec3(), normal);
            prop_assert!(lit >= LIT, "{lit} at {point}, texel {:?}", frame.views[0].texel.world);
        }
    }
}
