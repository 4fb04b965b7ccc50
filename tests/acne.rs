//! No plane shadows itself: planes at any slope, rasterised as a GPU does, looked up through the Rust twins, near the
//! origin of render space and far from it, in uniform maps and in warped ones.

mod common;

use antumbra::encoding::depth::{DepthMap, antumbra_caster, antumbra_visible};
use antumbra::encoding::split::antumbra_visibility;
use antumbra::lab::raster::{DepthMode, DepthTarget, RasterPass, rasterise};
use antumbra::lab::scene::{SOLID, SceneModel};
use antumbra::warp::{Focus, Warp};
use antumbra::{
    Aabb, Camera, DepthLaw, Encoding, FitInput, Grazing, Light, MapBudget, MapShape, Part, Pcf, Remix, Scene,
    ShadowFrame, ShadowTechnique, techniques,
};
use common::tally::Tally;
use common::{direction, view_point};
use glam::{DMat3, DVec2, DVec3, DVec4, UVec2, Vec3};
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
        log_distance in prop_oneof![Just(-9.0), 0.0..6.0_f64], filter in 0..Pcf::ALL.len(), log_side in 6..9_u32,
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

/// The depths of a plane at the centres of a warped map's texels, solved for in f64 and narrowed once: what a perfect
/// rasteriser would store if depths had no least value. `level` is (n, -n · p): zero on the plane.
fn solved(frame: &ShadowFrame, level: DVec4) -> Vec<f32> {
    let (view, side) = (&frame.views[0], frame.map.side);
    let clip = view.clip_from_render.as_dmat4();
    let (x_row, y_row, z_row, w_row) = (clip.row(0), clip.row(1), clip.row(2), clip.row(3));
    let depth_row = view.depth_from_render.as_dvec4();
    let ring = view.viewport.x;
    let drawn = f64::from(view.viewport.z);
    let depth_at = |x: u32, y: u32| {
        if x < ring || y < ring || x >= side - ring || y >= side - ring {
            return 1.0;
        }
        // The point of the plane on the texel's ray: three planes meet there.
        let ndc = DVec2::new(f64::from(x - ring) * 2.0 + 1.0 - drawn, drawn - f64::from(y - ring) * 2.0 - 1.0) / drawn;
        let planes = [x_row - w_row * ndc.x, y_row - w_row * ndc.y, level];
        let normals = DMat3::from_cols(planes[0].truncate(), planes[1].truncate(), planes[2].truncate()).transpose();
        let at = (normals.inverse() * -DVec3::from_array(planes.map(|plane| plane.w))).extend(1.0);
        let (z, w) = (z_row.dot(at), w_row.dot(at));
        if at.is_finite() && w > 0.0 && z <= w {
            let depth = if frame.wgsl.shape.writes_depth() { depth_row.dot(at) } else { z / w };
            depth.min(1.0) as f32
        } else {
            1.0
        }
    };
    (0..side * side).map(|texel| depth_at(texel % side, texel / side)).collect()
}

/// The same triangle through the laboratory's rasteriser, by the rules of GPUs, in one of a frame's maps.
fn drawn(frame: &ShadowFrame, view: usize, corners: &Corners) -> Vec<f32> {
    let model = SceneModel {
        positions: corners.iter().map(|corner| corner.as_dvec3()).collect(),
        uvs: vec![DVec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
        triangle_cutout: vec![SOLID],
        objects: Vec::new(),
        ..SceneModel::default()
    };
    let view = &frame.views[view];
    let mut target = DepthTarget::new(view.viewport.z, view.viewport.w, DepthMode::LessEqual);
    let depth_from_render = frame.wgsl.shape.writes_depth().then_some(view.depth_from_render);
    let pass = RasterPass { clip_from_render: view.clip_from_render, depth_from_render, origin: DVec3::ZERO };
    rasterise(&mut target, &model, core::slice::from_ref(&(0..1)), &pass);
    let (side, ring) = (frame.map.side as usize, view.viewport.x as usize);
    let mut map = vec![1.0; side * side];
    for (row, depths) in target.depth.chunks_exact(view.viewport.z as usize).enumerate() {
        let start = (row + ring) * side + ring;
        map[start..start + depths.len()].copy_from_slice(depths);
    }
    map
}

/// Every warp: as the papers have it, as they are guarded, and of any strength by hand.
fn warp() -> impl Strategy<Value = Warp> {
    prop_oneof![
        3 => (-0.83..2.48_f32).prop_map(|log| Warp::Fixed { strength: 10.0_f32.powf(log) }),
        1 => (0.0..1.0_f32).prop_map(|share| Warp::Trapezoidal { focus: Focus::Share(share) }),
        1 => Just(Warp::LightSpacePerspective),
        1 => (-3.0..2.0_f32).prop_map(|log| Warp::Perspective { pull_back: 10.0_f32.powf(log) }),
        1 => Just(Warp::Minimax),
        1 => Just(Warp::LeastError),
    ]
}

/// A warped map of a plane: a scene somewhere in render space, a camera somewhere in it, and a plane at a slope to the
/// light.
#[derive(Clone, Debug)]
struct Warped {
    travel: DVec3,
    middle: DVec3,
    half: DVec3,
    camera: Camera,
    remix: Remix,
    side: u32,
    corners: Corners,
    normal: Vec3,
}

impl Warped {
    fn bounds(&self) -> Aabb {
        Aabb::new(self.middle - self.half, self.middle + self.half)
    }

    /// `None` where there is nothing to shadow.
    fn frame(&self) -> Option<ShadowFrame> {
        self.frame_of(1)
    }

    /// The same with several maps.
    fn frame_of(&self, maps: u32) -> Option<ShadowFrame> {
        let input = FitInput {
            camera: self.camera,
            light: Light::Directional { travel: self.travel },
            scene: Scene::within(self.bounds()),
            map: MapBudget { side: self.side, layers: maps, views: maps },
            origin: DVec3::ZERO,
            previous: None,
        };
        Some(self.remix.fit(&input).unwrap()).filter(|frame| !frame.views.is_empty())
    }

    /// How far above the plane something must be, along its normal, to shade a point of it altogether: two reaches of
    /// the plane's fall (up to the highest texel that the bias must clear, and as far again) and the reach's growth,
    /// and one step more.
    fn clear_of_bias(&self, frame: &ShadowFrame, point: DVec3) -> f64 {
        let view = &frame.uniforms.views[0];
        let row = |row: [f32; 4]| DVec4::from_array(row.map(f64::from));
        let (at, normal) = (point.extend(1.0), self.normal.as_dvec3());
        let w = row(view.w_from_render).dot(at);
        let [u, v] = [view.u_from_render, view.v_from_render].map(|axis| row(axis).dot(at) / w);
        let [along_u, along_v, shared] =
            [view.across_u, view.across_v, view.across_w].map(|across| row(across).truncate().dot(normal));
        let step = w * w * ((along_v - v * shared).abs() + (u * shared - along_u).abs());
        let reach = frame.wgsl.filter.reach() + f64::from(view.bias[0]);
        let growth = (2.21 * reach * f64::from(view.bias[2]) * w).min(0.5);
        // What rounding may add, along the light.
        let exact = frame.views[0].depth_from_render.as_dvec4();
        let lost =
            f64::from(frame.views[0].depth_from_render.w - view.depth_from_render[3]) / exact.truncate().length();
        (2.0 * reach + 1.0) * step / (1.0 - growth) + 2.0 * lost
    }

    /// (n, −n · p) of the plane as it was narrowed.
    fn level(&self) -> DVec4 {
        let [a, b, c] = self.corners.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize();
        normal.extend(-normal.dot(a))
    }

    /// Where a pixel's ray meets the plane, within the scene and the camera's range.
    fn seen(&self, pixel: [f64; 2]) -> Option<DVec3> {
        let [start, end] = [0.0, 1.0].map(|depth| view_point(&self.camera, [pixel[0], pixel[1], depth]));
        let level = self.level();
        let [above, below] = [start, end].map(|at| level.dot(at.extend(1.0)));
        let share = above / (above - below);
        let at = start + (end - start) * share;
        let bounds = self.bounds();
        let inside = at.cmpge(bounds.min).all() && at.cmple(bounds.max).all();
        ((0.0..=1.0).contains(&share) && inside).then_some(at)
    }
}

/// Grazing light, the widest filter, small maps, flat scenes and near eyes more often than not: what moves receivers
/// through many texels that differ.
fn warped() -> impl Strategy<Value = Warped> {
    let plane = (direction(), direction(), prop_oneof![-4.0..0.0_f64, -3.5..-2.0_f64]);
    let place = (-1.0..3.0_f64, direction(), prop_oneof![3 => Just(-9.0), 1 => 0.0..4.0_f64]);
    let shape = prop::array::uniform3(prop_oneof![Just(0.0), -2.0..0.0_f64]);
    let eye = (direction(), direction(), prop_oneof![Just(0.0), 0.0..2.0_f64], 0.3..2.0_f64, -3.0..-1.0_f64);
    let law = prop_oneof![Just(DepthLaw::Linear), Just(DepthLaw::Projective)];
    let map = (warp(), any::<bool>(), prop_oneof![0..Pcf::ALL.len(), Just(Pcf::ALL.len() - 1)], 6..9_u32, law);
    (plane, place, shape, eye, map).prop_filter_map("no plane", |(plane, place, shape, eye, map)| {
        let ((travel, tilt, log_cosine), (log_size, away, log_distance)) = (plane, place);
        let (to, aside, distance, fov, near) = eye;
        let (warp, guard, filter, log_side, depth) = map;
        let size = 10.0_f64.powf(log_size);
        let half = DVec3::from_array(shape.map(|log| size * 10.0_f64.powf(log)));
        let middle = away * 10.0_f64.powf(log_distance);
        let cosine = 10.0_f64.powf(log_cosine);
        let flat = (tilt - travel * tilt.dot(travel)).try_normalize()?;
        let normal = (flat * (1.0 - cosine * cosine).sqrt() - travel * cosine).normalize();
        // Narrowing may turn a plane that grazes the light over to its other side.
        let (corners, normal) = triangle(middle, normal, size).filter(|(_, n)| n.as_dvec3().dot(travel) < 0.0)?;
        let target = middle + aside * 0.5 * half;
        let eye = target + to * (distance * size + 0.01 * size);
        let up = if to.y.abs() > 0.9 { DVec3::X } else { DVec3::Y };
        let near = 10.0_f64.powf(near) * size;
        let camera = Camera::perspective(Camera::look_at(eye, target, up), fov, 1.5, near, 10.0 * size);
        let remix = Remix { warp, guard, depth, encoding: Encoding::Depth(Pcf::ALL[filter]), ..Remix::default() };
        Some(Warped { travel, middle, half, camera, remix, side: 1 << log_side, corners, normal })
    })
}

/// Frames of composites, those of several maps and of one, and points that were looked up.
static COMPOSITES: Tally<4> = Tally::new();

/// The same for the composites by name. What `smra` blurs is not compared but estimated, which `tests/leaks` has, and
/// half light where light grazes is no mistake of its maps: here they are read as depths, by every filter.
#[test]
fn no_plane_shadows_itself_in_composites() {
    over_composites();
    let [frames, several, one, points] = COMPOSITES.read();
    println!("{frames} frames, {several} of several maps, {one} of one, {points} points");
    assert!(several > 1_000 && one > 30 && points > 10_000, "{frames} {several} {one} {points}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4_000, max_shrink_iters: 200, ..ProptestConfig::default() })]

    /// The same for warped maps, on what the camera sees of the plane.
    #[test]
    fn no_plane_shadows_itself_in_warped_maps(
        case in warped(), exact in any::<bool>(),
        pixels in prop::collection::vec(prop::array::uniform2(0.0..1.0_f64), 100),
    ) {
        let Some(frame) = case.frame() else { return Ok(()) };
        prop_assert!(frame.wgsl.shape != MapShape::Affine);
        let depth = if exact { solved(&frame, case.level()) } else { drawn(&frame, 0, &case.corners) };
        let map = DepthMap { size: UVec2::splat(frame.map.side), depth: &depth };
        for point in pixels.into_iter().filter_map(|pixel| case.seen(pixel)) {
            let lit = antumbra_visible(frame.wgsl, &frame.uniforms.views[0], &map, point.as_vec3(), case.normal);
            prop_assert!(
                lit >= LIT,
                "{lit} at {point}, strength {}, texel {:?}", frame.views[0].warp_strength, frame.views[0].texel.world
            );
        }
    }

    fn over_composites(
        case in warped(), plus in any::<bool>(), pixels in prop::collection::vec(prop::array::uniform2(0.0..1.0_f64), 100),
    ) {
        let smra = Remix { encoding: case.remix.encoding, grazing: Grazing::Off, ..techniques::smra() };
        let case = Warped { remix: if plus { techniques::smra_plus() } else { smra }, ..case };
        let Some(frame) = case.frame_of(4) else { return Ok(()) };
        COMPOSITES.count(0);
        COMPOSITES.count(if frame.views.len() > 1 { 1 } else { 2 });
        let depths: Vec<_> = (0..frame.views.len()).map(|view| drawn(&frame, view, &case.corners)).collect();
        let maps: Vec<_> = depths.iter().map(|depth| DepthMap { size: UVec2::splat(frame.map.side), depth }).collect();
        for point in pixels.into_iter().filter_map(|pixel| case.seen(pixel)) {
            let depth = -case.camera.world_from_view.inverse().transform_point3(point).z as f32;
            let lit = antumbra_visibility(frame.wgsl, &frame.uniforms, &maps, point.as_vec3(), case.normal, depth);
            COMPOSITES.count(3);
            prop_assert!(lit >= LIT, "{lit} at {point}, {depth} from the eye, {} maps", frame.views.len());
        }
    }

    /// Nor does the bias eat shadows: what is a texel's fall above the plane beyond the reach of a filter shades it.
    #[test]
    fn what_is_near_a_plane_shades_it_in_warped_maps(
        case in warped(), pixels in prop::collection::vec(prop::array::uniform2(0.0..1.0_f64), 20),
    ) {
        // Depth over w falls towards the base line, and so the other law's bias is larger:
        // by the depth itself times the growth of w.
        let case = Warped { remix: Remix { depth: DepthLaw::Linear, ..case.remix }, ..case };
        let Some(frame) = case.frame() else { return Ok(()) };
        let Some(point) = pixels.into_iter().find_map(|pixel| case.seen(pixel)) else { return Ok(()) };
        // Where f32 positions are coarser than texels, shadows are as coarse as positions.
        if frame.uniforms.views[0].bias[0] > 1.0 {
            return Ok(());
        }
        // Near the rim of maps that are too small for it, a filter reads light from beyond; the report says so.
        if frame.left_out.iter().any(|cut| cut.part == Part::Border(0)) {
            return Ok(());
        }
        // A sheet above the whole plane, as near as it may be at the point.
        let side = case.level().truncate().dot(case.normal.as_dvec3()).signum();
        let above = case.level() - DVec4::W * case.clear_of_bias(&frame, point) * side;
        let depth = solved(&frame, above);
        let map = DepthMap { size: UVec2::splat(frame.map.side), depth: &depth };
        let lit = antumbra_visible(frame.wgsl, &frame.uniforms.views[0], &map, point.as_vec3(), case.normal);
        prop_assert!(lit <= 1.0 - LIT, "{lit} at {point}, strength {}", frame.views[0].warp_strength);
    }
}
