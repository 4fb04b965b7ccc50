//! What engines expect of cascades: the eight properties that the best-tested peer checks for its own, and those that
//! it does not: light along the camera's up, light along the view, a world far from its origin, no shimmer.

use antumbra::split::depth::planes;
use antumbra::{
    Aabb, Camera, ClipDepth, Content, DepthSplits, FitInput, Light, MapBudget, MapShape, Projection, Remix, Scene,
    Scheme, Select, ShadowFrame, ShadowTechnique, Split, Stabilise, Warp, techniques,
};
use glam::{DMat4, DQuat, DVec2, DVec3, UVec2};

const PRACTICAL: Scheme = Scheme::Practical { lambda: 0.5, offset: 0.0 };

/// Four snapped cascades that are found by depth and blended over a tenth.
fn cascades() -> Remix {
    let splits = DepthSplits { maps: 4, scheme: PRACTICAL, select: Select::Depth, blend: 0.1, fade: true, enough: 0.0 };
    Remix { split: Split::Depth(splits), warp: Warp::Focused, stabilise: Stabilise::SnapTexels, ..Remix::default() }
}

/// The same, fitted tightly.
fn tight() -> Remix {
    Remix { stabilise: Stabilise::Off, ..cascades() }
}

/// These, and the composites by name.
fn all() -> [Remix; 4] {
    [cascades(), tight(), techniques::smra(), techniques::smra_plus()]
}

fn fit(remix: &Remix, camera: Camera, travel: DVec3, side: u32, origin: DVec3) -> ShadowFrame {
    let centre = camera.world_from_view.w_axis.truncate();
    let scene = Scene::within(Aabb::new(centre - 5000.0, centre + 5000.0));
    let map = MapBudget { side, layers: 4, views: 4 };
    let input = FitInput { camera, light: Light::Directional { travel }, scene, map, origin, previous: None };
    remix.fit(&input).expect("legal")
}

fn camera(near: f64, far: f64) -> Camera {
    let world_from_view = Camera::look_at(DVec3::new(3.0, 4.0, 5.0), DVec3::new(0.0, 1.0, -20.0), DVec3::Y);
    Camera::perspective(world_from_view, 1.0, 1.5, near, far)
}

fn sun() -> DVec3 {
    DVec3::new(0.4, -0.8, 0.3).normalize()
}

fn finite(frame: &ShadowFrame) -> bool {
    frame.views.iter().all(|view| view.clip_from_render.is_finite())
}

/// Corners of a perspective or orthographic camera's picture at a depth, world space.
fn corners(camera: &Camera, depth: f64) -> [DVec3; 4] {
    let (left, right, down, up, spread) = match camera.projection {
        Projection::Perspective { left, right, down, up, .. } => (left, right, down, up, depth),
        Projection::Orthographic { left, right, down, up, .. } => (left, right, down, up, 1.0),
    };
    [(left, down), (right, down), (left, up), (right, up)]
        .map(|(x, y)| camera.world_from_view.transform_point3(DVec3::new(x * spread, y * spread, -depth)))
}

/// Where a world point is in a view, as f32 renders it.
fn clip(frame: &ShadowFrame, view: usize, point: DVec3, origin: DVec3) -> DVec3 {
    let at = frame.views[view].clip_from_render * (point - origin).as_vec3().extend(1.0);
    at.truncate().as_dvec3() / f64::from(at.w)
}

/// By how much the farthest depth of a warped map may lie beyond 1: in a world 100,000 times as large as the slice, f32
/// loses 6e-5 of a depth that is divided. Nothing that the slice shows lies behind it.
const ROUNDED: f64 = 1e-4;

/// Every view holds the corners of the depths that it serves.
fn holds_its_slices(frame: &ShadowFrame, camera: &Camera, far: f64, origin: DVec3) {
    assert_eq!(frame.views.len(), usize::from(frame.wgsl.maps), "{:?}", frame.left_out);
    let farthest = if frame.wgsl.shape == MapShape::Affine { 1.0 } else { 1.0 + ROUNDED };
    for view in 0..frame.views.len() {
        let [from, to, ..] = frame.uniforms.views[view].domain;
        for depth in [f64::from(from), f64::from(to).min(far)] {
            for corner in corners(camera, depth) {
                let at = clip(frame, view, corner, origin);
                let held = at.truncate().abs().max_element() <= 1.0 && (-1e-6..=farthest).contains(&at.z);
                assert!(held, "view {view} of {:?} at {at}", frame.wgsl.shape);
            }
        }
    }
}

#[test]
fn splits_begin_and_end_with_the_range() {
    for scheme in [Scheme::Uniform, Scheme::Logarithmic, PRACTICAL] {
        let planes = planes(&scheme, 4, 0.3, 900.0).unwrap();
        assert_eq!((planes[0], planes[4]), (0.3, 900.0));
    }
}

#[test]
fn orthographic_cameras_may_begin_at_zero() {
    let projection = Projection::Orthographic { left: -8.0, right: 8.0, down: -5.0, up: 5.0, near: 0.0, far: 120.0 };
    let camera = Camera { projection, ..camera(0.1, 100.0) };
    for remix in all() {
        let frame = fit(&remix, camera, sun(), 1024, DVec3::ZERO);
        assert!(finite(&frame));
        holds_its_slices(&frame, &camera, 120.0, DVec3::ZERO);
    }
}

#[test]
fn endless_views_end_with_the_scene_or_what_is_visible() {
    let camera = camera(0.1, f64::INFINITY);
    for remix in all() {
        assert!(finite(&fit(&remix, camera, sun(), 1024, DVec3::ZERO)));
        let scene = Scene {
            visible_depth: Some(antumbra::DepthRange { near: 0.1, far: 200.0 }),
            ..Scene::within(Aabb::new(DVec3::splat(-5000.0), DVec3::splat(5000.0)))
        };
        let map = MapBudget { side: 1024, layers: 4, views: 4 };
        let light = Light::Directional { travel: sun() };
        let input = FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None };
        let frame = remix.fit(&input).unwrap();
        holds_its_slices(&frame, &camera, 200.0, DVec3::ZERO);
    }
}

/// A band begins within its own slice, ends where the next slice begins, and lies in both maps.
#[test]
fn bands_nest() {
    let camera = camera(0.1, 150.0);
    for remix in [cascades(), tight()] {
        let frame = fit(&remix, camera, sun(), 1024, DVec3::ZERO);
        for view in 0..4 {
            let [near, far, from, per_depth] = frame.uniforms.views[view].domain;
            assert!(near < from && from < far && (per_depth * (far - from) - 1.0).abs() < 1e-3);
            assert!(view == 3 || frame.uniforms.views[view + 1].domain[0] == far);
            for point in corners(&camera, f64::from(from)).into_iter().chain(corners(&camera, f64::from(far))) {
                for map in [view, (view + 1).min(3)] {
                    let at = clip(&frame, map, point, DVec3::ZERO);
                    assert!(at.truncate().abs().max_element() <= 1.0 && at.z <= 1.0, "map {map} at {at}");
                }
            }
        }
    }
}

#[test]
fn casters_far_towards_the_light_are_in_every_map() {
    let camera = camera(0.1, 150.0);
    for remix in all() {
        let frame = fit(&remix, camera, sun(), 1024, DVec3::ZERO);
        for view in 0..frame.views.len() {
            let [near, far, ..] = frame.uniforms.views[view].domain;
            // The last slice may have no end.
            for point in corners(&camera, f64::from(0.5 * (near + far.min(150.0)))) {
                let caster = point - sun() * 90.0;
                assert!(frame.views[view].cull.may_cast(&Aabb::new(caster, caster)));
                assert!(clip(&frame, view, caster, DVec3::ZERO).z >= 0.0);
            }
        }
    }
}

#[test]
fn slices_are_inside_of_their_maps() {
    for (near, far) in [(0.1, 150.0), (0.01, 0.1), (1.0, 4000.0)] {
        let camera = camera(near, far);
        for remix in all() {
            holds_its_slices(&fit(&remix, camera, sun(), 1024, DVec3::ZERO), &camera, far, DVec3::ZERO);
        }
    }
}

#[test]
fn snapping_cuts_nothing_in_small_maps() {
    let camera = camera(0.1, 150.0);
    holds_its_slices(&fit(&cascades(), camera, sun(), 16, DVec3::ZERO), &camera, 150.0, DVec3::ZERO);
}

#[test]
fn reversed_depth_is_the_same_camera() {
    let camera = camera(0.1, 150.0);
    let near_is_one = DMat4::from_cols_array_2d(&[
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0, 1.0],
    ]);
    let standard = glam::dmat4(
        glam::dvec4(1.0 / (0.5_f64.tan() * 1.5), 0.0, 0.0, 0.0),
        glam::dvec4(0.0, 1.0 / 0.5_f64.tan(), 0.0, 0.0),
        glam::dvec4(0.0, 0.0, 150.0 / (0.1 - 150.0), -1.0),
        glam::dvec4(0.0, 0.0, 150.0 * 0.1 / (0.1 - 150.0), 0.0),
    );
    let reversed = Camera::from_matrices(camera.world_from_view, near_is_one * standard, ClipDepth::ZeroToOne);
    let reversed = reversed.expect("a legal projection");
    for remix in all() {
        let frame = fit(&remix, reversed, sun(), 1024, DVec3::ZERO);
        assert!(finite(&frame));
        holds_its_slices(&frame, &camera, 150.0, DVec3::ZERO);
    }
}

#[test]
fn light_may_run_along_up_and_along_the_view() {
    let camera = camera(0.1, 150.0);
    let view = -camera.world_from_view.z_axis.truncate();
    for travel in [DVec3::NEG_Y, DVec3::Y, view, -view, (view + DVec3::X * 1e-9).normalize()] {
        for remix in all() {
            holds_its_slices(&fit(&remix, camera, travel, 1024, DVec3::ZERO), &camera, 150.0, DVec3::ZERO);
        }
    }
}

#[test]
fn worlds_may_be_far_from_their_origin() {
    let eye = DVec3::new(1e7, 2e6, -1e7);
    let mut camera = camera(0.1, 150.0);
    camera.world_from_view.w_axis = eye.extend(1.0);
    for remix in all() {
        holds_its_slices(&fit(&remix, camera, sun(), 1024, eye), &camera, 150.0, eye);
    }
}

/// Over 300 frames at 60 Hz, flying at 6 m/s and turning by 40° a second: points of the world keep their place among
/// the texels of every map, to a thousandth of one.
#[test]
fn snapped_maps_do_not_shimmer() {
    let remix = cascades();
    let points: Vec<DVec3> =
        (0..20).map(|i| DVec3::new(f64::from(i) * 1.7 - 15.0, 0.3 * f64::from(i % 3), f64::from(i) * -3.0)).collect();
    let mut last: Option<(ShadowFrame, DVec3)> = None;
    let (mut worst, mut compared) = (0.0_f64, 0);
    for step in 0..300 {
        let time = f64::from(step) / 60.0;
        let eye = DVec3::new(6.0 * time, 2.0, 5.0 - time);
        let turn =
            DQuat::from_rotation_y(40_f64.to_radians() * time) * DQuat::from_rotation_x(0.1 * (2.0 * time).sin());
        let mut camera = Camera::perspective(DMat4::from_rotation_translation(turn, eye), 1.0, 1.5, 0.1, 150.0);
        camera.viewport = UVec2::new(800, 600);
        let scene = Scene::within(Aabb::new(DVec3::splat(-5000.0), DVec3::splat(5000.0)));
        let map = MapBudget { side: 1024, layers: 4, views: 4 };
        let input =
            FitInput { camera, light: Light::Directional { travel: sun() }, scene, map, origin: eye, previous: None };
        let frame = remix.fit(&input).unwrap();
        assert_eq!(frame.views.len(), 4);
        let texels = |frame: &ShadowFrame, view: usize, point: DVec3, origin: DVec3| -> DVec2 {
            let matrix = frame.views[view].clip_from_render.as_dmat4();
            (matrix * (point - origin).extend(1.0)).truncate().truncate()
                * 0.5
                * f64::from(frame.views[view].viewport.z)
        };
        if let Some((last, last_eye)) = &last {
            for view in 0..4 {
                for point in &points {
                    let moved = texels(&frame, view, *point, eye) - texels(last, view, *point, *last_eye);
                    worst = worst.max((moved - moved.round()).abs().max_element());
                    compared += 1;
                }
            }
        }
        last = Some((frame, eye));
    }
    println!("largest part of a texel that maps move by: {worst:.1e} of {compared}");
    assert!(compared == 299 * 4 * 20 && worst <= 1e-3, "{worst}");
}

/// What an engine that keeps maps is told along a walk: after the first frame nothing is drawn as a whole again, and
/// what scrolls does so by as many texels as points of the world move.
#[test]
fn snapped_maps_scroll_or_stay() {
    let remix = cascades();
    let point = DVec3::new(2.0, 1.0, -9.0);
    let mut last: Option<(ShadowFrame, DVec3)> = None;
    let (mut unchanged, mut scrolled) = (0, 0);
    for step in 0..200 {
        // Every second frame stands still.
        let time = f64::from(step / 2) / 30.0;
        let eye = DVec3::new(1.4 * time, 1.7, 5.0 - 0.5 * time);
        let turn = DQuat::from_rotation_y(0.5 * time);
        let camera = Camera::perspective(DMat4::from_rotation_translation(turn, eye), 1.0, 1.5, 0.1, 100.0);
        let scene = Scene::within(Aabb::new(DVec3::new(-150.0, 0.0, -150.0), DVec3::new(150.0, 20.0, 150.0)));
        let map = MapBudget { side: 1024, layers: 4, views: 4 };
        let light = Light::Directional { travel: sun() };
        let previous = last.as_ref().map(|(frame, _)| frame);
        let frame = remix.fit(&FitInput { camera, light, scene, map, origin: eye, previous }).unwrap();
        let texel = |frame: &ShadowFrame, view: usize, origin: DVec3| {
            let at = clip(frame, view, point, origin).truncate() * 0.5 * f64::from(frame.views[view].viewport.z);
            DVec2::new(at.x, -at.y)
        };
        for (index, view) in frame.views.iter().enumerate() {
            let Some((before, before_eye)) = &last else {
                assert_eq!(view.content, Content::Redraw);
                continue;
            };
            let moved = texel(&frame, index, eye) - texel(before, index, *before_eye);
            match view.content {
                Content::Redraw => panic!("view {index} of step {step} is drawn again"),
                Content::Unchanged => unchanged += 1,
                Content::Scrolled { texels } => {
                    scrolled += 1;
                    assert!((moved + texels.as_dvec2()).abs().max_element() < 0.05, "{moved} and {texels}");
                }
            }
        }
        last = Some((frame, eye));
    }
    println!("{unchanged} unchanged, {scrolled} scrolled");
    assert!(unchanged > 100 && scrolled > 100);
    // Tight maps have no texels to keep.
    let (frame, eye) = last.unwrap();
    let camera = camera(0.1, 100.0);
    let scene = Scene::within(Aabb::new(DVec3::splat(-150.0), DVec3::splat(150.0)));
    let map = MapBudget { side: 1024, layers: 4, views: 4 };
    let light = Light::Directional { travel: sun() };
    let input = FitInput { camera, light, scene, map, origin: eye, previous: Some(&frame) };
    let tight = tight().fit(&input).unwrap();
    assert!(tight.views.iter().all(|view| view.content == Content::Redraw));
}

/// Scenes that do not need splits do not get them: how many views there are, and why no more.
mod what_is_left_out {
    use super::*;
    use antumbra::{Object, Part, Why};

    fn shot(scene: Scene, camera: Camera, travel: DVec3, side: u32) -> ShadowFrame {
        let map = MapBudget { side, layers: 4, views: 4 };
        let light = Light::Directional { travel };
        let input = FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None };
        let frame = techniques::cascades().fit(&input).expect("legal");
        let reasons: Vec<String> = frame.left_out.iter().map(ToString::to_string).collect();
        println!(
            "{} views, {:.3} pixels a texel at most; {}",
            frame.views.len(),
            frame.predicted.max,
            reasons.join("; ")
        );
        // Uniforms that are not in use read lit.
        for unused in &frame.uniforms.views[frame.views.len()..] {
            assert_eq!(*unused, antumbra::ViewUniforms::LIT);
        }
        assert_eq!(frame.uniforms.counts[0] as usize, frame.views.len());
        frame
    }

    fn splits_left_out(frame: &ShadowFrame) -> Vec<Why> {
        frame.left_out.iter().filter(|cut| matches!(cut.part, Part::Split(_))).map(|cut| cut.why).collect()
    }

    fn looking_along_z() -> Camera {
        let mut camera = Camera::perspective(DMat4::from_translation(DVec3::new(0.0, 1.7, 0.0)), 1.0, 1.5, 0.1, 500.0);
        camera.viewport = UVec2::new(800, 600);
        camera
    }

    /// Light that falls in through the end of a corridor: all of it is as wide as its section, which the view takes in
    /// as a whole from some way off. From inside, the view is narrower than the section at first, and maps of that are
    /// finer.
    #[test]
    fn a_corridor_lit_along_it() {
        let corridor = Aabb::new(DVec3::new(-2.0, 0.0, -60.0), DVec3::new(2.0, 3.0, 0.0));
        assert_eq!(shot(Scene::within(corridor), looking_along_z(), DVec3::Z, 1024).views.len(), 3);
        let mut outside = looking_along_z();
        outside.world_from_view.w_axis.z = 6.0;
        let frame = shot(Scene::within(corridor), outside, DVec3::Z, 1024);
        assert_eq!(frame.views.len(), 1);
        assert!(splits_left_out(&frame).iter().all(|why| matches!(why, Why::MetBy { split: 0 })));
        assert_eq!(splits_left_out(&frame).len(), 3);
        // Lit from above, it is as long as it is.
        assert_eq!(shot(Scene::within(corridor), looking_along_z(), sun(), 1024).views.len(), 4);
    }

    #[test]
    fn a_single_small_object() {
        let object = Aabb::new(DVec3::new(-0.5, 1.0, -31.0), DVec3::new(0.5, 2.0, -30.0));
        let frame = shot(Scene::within(object), looking_along_z(), sun(), 1024);
        assert_eq!(frame.views.len(), 1);
        assert_eq!(splits_left_out(&frame).len(), 3);
        // A map of too few texels gets help.
        assert!(shot(Scene::within(object), looking_along_z(), sun(), 32).views.len() > 1);
    }

    #[test]
    fn an_empty_sky() {
        let ground = Aabb::new(DVec3::new(-100.0, -10.0, -100.0), DVec3::new(100.0, 0.0, 100.0));
        let up = DMat4::from_rotation_translation(DQuat::from_rotation_x(1.2), DVec3::Y * 20.0);
        let frame = shot(Scene::within(ground), Camera::perspective(up, 1.0, 1.5, 0.1, 500.0), sun(), 1024);
        assert!(frame.views.is_empty());
        assert!(matches!(frame.left_out[0].why, Why::NoReceiversInView { .. }));
    }

    /// What is far away begins far away: no map is spent on the air before it.
    #[test]
    fn receivers_in_the_distance() {
        let hill = Aabb::new(DVec3::new(-300.0, 0.0, -420.0), DVec3::new(300.0, 60.0, -400.0));
        let frame = shot(Scene::within(hill), looking_along_z(), DVec3::new(0.2, -0.5, -0.8).normalize(), 1024);
        assert!(frame.views.len() < 4, "{:?}", frame.left_out);
        assert!(frame.uniforms.views[0].domain[0] >= 399.0 || frame.views.len() == 1);
    }

    /// Slices in which nothing casts have no map; neighbours do not reach into them.
    #[test]
    fn slices_without_casters() {
        let ground = Aabb::new(DVec3::new(-200.0, 0.0, -400.0), DVec3::new(200.0, 0.1, 0.0));
        let hut =
            |z: f64| Object { bounds: Aabb::new(DVec3::new(-3.0, 0.0, z - 6.0), DVec3::new(3.0, 4.0, z)), casts: true };
        let objects = [hut(-10.0), hut(-380.0)];
        let casters = objects[0].bounds.union(objects[1].bounds);
        let scene = Scene { casters, receivers: ground, objects: &objects, ..Scene::within(ground) };
        let splits = DepthSplits {
            scheme: Scheme::Uniform,
            select: Select::Depth,
            blend: 0.3,
            enough: 0.0,
            ..DepthSplits::DEFAULT
        };
        let remix = Remix { split: Split::Depth(splits), warp: Warp::Focused, ..Remix::default() };
        let light = Light::Directional { travel: DVec3::new(0.1, -1.0, 0.0).normalize() };
        let map = MapBudget { side: 1024, layers: 4, views: 4 };
        let input = FitInput { camera: looking_along_z(), light, scene, map, origin: DVec3::ZERO, previous: None };
        let frame = remix.fit(&input).unwrap();
        println!("{:?}", frame.left_out);
        assert_eq!(frame.views.len(), 2);
        let bare = splits_left_out(&frame);
        assert_eq!(bare.iter().filter(|why| matches!(why, Why::NothingCastsHere)).count(), 2, "{bare:?}");
        assert_eq!(frame.uniforms.views[0].domain[3], 0.0, "no band into a map that does not hold it");
    }

    #[test]
    fn budgets_are_kept() {
        let world = Aabb::new(DVec3::splat(-500.0), DVec3::splat(500.0));
        for (views, layers, expected) in [(4, 4, 4), (2, 4, 2), (4, 1, 1), (8, 8, 4)] {
            let map = MapBudget { side: 1024, layers, views };
            let light = Light::Directional { travel: sun() };
            let scene = Scene::within(world);
            let input = FitInput { camera: looking_along_z(), light, scene, map, origin: DVec3::ZERO, previous: None };
            let frame = techniques::cascades().fit(&input).unwrap();
            assert_eq!(frame.views.len(), expected);
            let without = frame.left_out.iter().filter(|cut| cut.why == Why::NoMapLeft).count();
            assert_eq!(without, 4 - expected);
        }
    }
}
