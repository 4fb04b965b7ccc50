//! Bugs, verbatim: the input that showed each, and one sentence.

mod splits;

use antumbra::{
    Aabb, Bias, Camera, Content, DepthRange, Encoding, FitError, FitInput, Light, MapBudget, MomentFormat, MomentKind,
    Moments, Object, Part, Pcf, Prefilter, Radius, Remix, Scene, ShadowFrame, ShadowTechnique, Stabilise, Why,
    techniques,
};
use glam::{DMat4, DVec3};

fn room(half: f64) -> Aabb {
    Aabb::new(DVec3::splat(-half), DVec3::splat(half))
}

fn input(scene: Scene) -> FitInput {
    FitInput {
        camera: Camera::perspective(DMat4::IDENTITY, 0.8, 1.5, 0.1, 100.0),
        light: Light::Directional { travel: DVec3::new(0.6, -0.8, 0.0) },
        scene,
        map: MapBudget::one(1024),
        origin: DVec3::ZERO,
        previous: None,
    }
}

fn whys(frame: &ShadowFrame) -> Vec<(Part, Why)> {
    frame.left_out.iter().map(|cut| (cut.part, cut.why)).collect()
}

/// Casters and receivers in one box: rounding of its silhouette planes was reported as "outside the shadow of the
/// casters", and hid the cut that the visible depth made.
#[test]
fn reasons_are_true_and_none_hides_another() {
    let scene = Scene { visible_depth: Some(DepthRange { near: 5.0, far: 50.0 }), ..Scene::within(room(300.0)) };
    let frame = techniques::fsm().fit(&input(scene)).unwrap();
    assert_eq!(whys(&frame), [(Part::Frustum, Why::NotVisible { near: 5.0, far: 50.0 })]);
    let ahead = DVec3::new(0.0, 3.0, -20.0);
    let small = Scene { casters: Aabb::new(ahead - 2.0, ahead + 2.0), ..scene };
    let both = whys(&techniques::fsm().fit(&input(small)).unwrap());
    assert!(both.contains(&(Part::Receivers(0), Why::LitWithoutLookup)), "{both:?}");
    assert!(both.contains(&(Part::Frustum, Why::NotVisible { near: 5.0, far: 50.0 })), "{both:?}");
}

/// A snapped map said that it stands still, and its depths followed the camera all the same.
#[test]
fn still_maps_are_still() {
    let remix = Remix { stabilise: Stabilise::SnapTexels, ..techniques::fsm() };
    let fit = |eye: DVec3| {
        let mut input = input(Scene::within(Aabb::new(DVec3::new(-9.0, 0.0, -9.0), DVec3::new(9.0, 6.0, 9.0))));
        input.camera.world_from_view = Camera::look_at(eye, DVec3::ZERO, DVec3::Y);
        remix.fit(&input).unwrap()
    };
    let (a, b) = (fit(DVec3::new(0.0, 3.0, 14.0)), fit(DVec3::new(5.0, 2.0, 12.0)));
    assert!(whys(&a).contains(&(Part::Stabilise(0), Why::AlreadyStill)));
    assert_eq!(a.views[0].clip_from_render, b.views[0].clip_from_render);
}

/// An infinite far plane was reported as "does not move with the camera" instead of what it is.
#[test]
fn an_endless_frustum_says_so() {
    let remix = Remix { stabilise: Stabilise::SnapTexels, ..techniques::fsm() };
    let mut input = input(Scene::within(room(30_000.0)));
    input.camera = Camera::perspective(DMat4::IDENTITY, 0.8, 1.5, 0.1, f64::INFINITY);
    assert!(whys(&remix.fit(&input).unwrap()).contains(&(Part::Stabilise(0), Why::EndlessFrustum)));
    input.scene.visible_depth = Some(DepthRange { near: 0.0, far: 100.0 });
    let frame = remix.fit(&input).unwrap();
    assert!(frame.views[0].texel.world[1] < 1.0, "{:?}", frame.views[0].texel);
}

/// The sun exactly along flat ground: "the view covers 23000000000000 % of the scene", and the focus was given up.
#[test]
fn shares_are_shares() {
    let ground = Aabb::new(DVec3::new(-1000.0, 0.0, -1000.0), DVec3::new(1000.0, 0.0, 1000.0));
    let mut input = input(Scene { visible_depth: Some(DepthRange { near: 0.1, far: 30.0 }), ..Scene::within(ground) });
    input.light = Light::Directional { travel: DVec3::X };
    input.camera.world_from_view = Camera::look_at(DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.0, 1.0, -10.0), DVec3::Y);
    let frame = techniques::fsm().fit(&input).unwrap();
    for (_, why) in whys(&frame) {
        assert!(!matches!(why, Why::SceneIsInView { share } if !(0.9..=1.0).contains(&share)), "{why:?}");
    }
    assert!(frame.views[0].texel.world[1] < 0.1, "{:?}", frame.views[0].texel);
}

/// The casters' box was said to be cut to the window and was not: a city's map was five times as deep as it had to be.
#[test]
fn depth_starts_at_the_first_caster_of_the_window() {
    let city = Aabb::new(DVec3::new(-1400.0, 0.0, -1400.0), DVec3::new(1400.0, 180.0, 1400.0));
    let mut input = input(Scene { visible_depth: Some(DepthRange { near: 0.1, far: 50.0 }), ..Scene::within(city) });
    input.light = Light::Directional { travel: DVec3::new(0.5, -0.6, 0.62).normalize() };
    input.camera.world_from_view = Camera::look_at(DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.0, 1.0, -10.0), DVec3::Y);
    let frame = techniques::fsm().fit(&input).unwrap();
    let range = 1.0 / frame.views[0].depth_from_render.truncate().length();
    // From the roofs, 180 up, along a light of slope 0.6, and the body's own 100 or so.
    assert!(range < 500.0, "{range}");
}

/// One object that casts, outside the window: a map was drawn for nothing, without a word.
#[test]
fn no_object_in_the_window_means_no_map() {
    let far = Object { bounds: Aabb::new(DVec3::splat(5000.0), DVec3::splat(5001.0)), casts: true };
    let idle = Object { bounds: room(1.0), casts: false };
    let objects = [far, idle];
    let frame = techniques::fsm().fit(&input(Scene { objects: &objects, ..Scene::within(room(6000.0)) })).unwrap();
    assert!(frame.views.is_empty());
    assert!(whys(&frame).contains(&(Part::Light, Why::NothingCastsHere)));
}

/// A map smaller than its filter's border said nothing.
#[test]
fn tiny_maps_say_what_they_lack() {
    for side in [1, 2, 4, 8] {
        let input = FitInput { map: MapBudget::one(side), ..input(Scene::within(room(30.0))) };
        let frame = techniques::fsm().fit(&input).unwrap();
        assert!(
            whys(&frame).iter().any(|(part, why)| *part == Part::Border(0) && matches!(why, Why::MapTooSmall { .. }))
        );
    }
    let enough = techniques::fsm().fit(&input(Scene::within(room(30.0)))).unwrap();
    assert!(!whys(&enough).iter().any(|(_, why)| matches!(why, Why::MapTooSmall { .. })));
}

/// A NaN among the points was forgotten, and with it all points before it.
#[test]
fn bounds_around_nan_are_refused_by_name() {
    let bounds = Aabb::around([DVec3::new(-5.0, 0.0, 0.0), DVec3::NAN, DVec3::ONE]);
    let error = techniques::fsm().fit(&input(Scene::within(bounds))).unwrap_err();
    assert!(matches!(error, FitError::NotFinite { field: "scene.casters.min", .. }), "{error}");
}

/// A manual bias of the largest f32 overflowed to infinity in the uniforms.
#[test]
fn manual_bias_is_bounded() {
    let fit = |depth_world, slope_texels, normal_texels| {
        let bias = Bias::Manual { depth_world, slope_texels, normal_texels };
        Remix { bias, ..techniques::fsm() }.fit(&input(Scene::within(room(1e-3))))
    };
    assert!(matches!(fit(f32::MAX, 0.0, 0.0), Err(FitError::OutOfRange { field: "bias.depth_world", .. })));
    assert!(matches!(fit(0.0, 2e9, 0.0), Err(FitError::OutOfRange { field: "bias.slope_texels", .. })));
    assert!(matches!(fit(0.0, 0.0, f32::INFINITY), Err(FitError::NotFinite { field: "bias.normal_texels", .. })));
    assert!(matches!(fit(-1.0, 0.0, 0.0), Err(FitError::OutOfRange { field: "bias.depth_world", .. })));
    let frame = fit(1e9, 1e9, 1e9).unwrap();
    assert!(frame.uniforms.views[0].bias.iter().all(|value| value.is_finite()));
}

/// Lights that are not served yet, and every kind of illegal input, are refused by name.
#[test]
fn refusals_name_the_field() {
    let good = input(Scene::within(room(30.0)));
    let field = |input: &FitInput| match techniques::fsm().fit(input).unwrap_err() {
        FitError::NotFinite { field, .. }
        | FitError::OutOfRange { field, .. }
        | FitError::NotUnit { field, .. }
        | FitError::NotRigid { field, .. }
        | FitError::NotYet { field, .. } => field,
        FitError::NotOrdered { lower, .. } => lower,
        other => panic!("{other}"),
    };
    let position = DVec3::ZERO;
    let spot = Light::Spot { position, travel: DVec3::X, half_angle: 0.5, range: 9.0 };
    for light in [spot, Light::Point { position, range: 9.0 }] {
        assert_eq!(field(&FitInput { light, ..good }), "light");
    }
    for (light, name) in [
        (Light::Point { position, range: 0.0 }, "light.range"),
        (Light::Point { position: DVec3::NAN, range: 1.0 }, "light.position"),
        (Light::Spot { position, travel: DVec3::X, half_angle: 1.6, range: 9.0 }, "light.half_angle"),
        (Light::Directional { travel: DVec3::ZERO }, "light.travel"),
        (Light::Directional { travel: DVec3::splat(f64::INFINITY) }, "light.travel"),
    ] {
        assert_eq!(field(&FitInput { light, ..good }), name);
    }
    for (map, name) in [
        (MapBudget { side: 0, ..good.map }, "map.side"),
        (MapBudget { side: 16_385, ..good.map }, "map.side"),
        (MapBudget { layers: 0, ..good.map }, "map.layers"),
        (MapBudget { views: 9, ..good.map }, "map.views"),
    ] {
        assert_eq!(field(&FitInput { map, ..good }), name);
    }
    let inverted = Aabb::new(DVec3::ONE, DVec3::ZERO);
    for (scene, name) in [
        (Scene { casters: inverted, ..good.scene }, "scene.casters.min"),
        (Scene { receivers: inverted, ..good.scene }, "scene.receivers.min"),
        (Scene { receivers: room(1e16), ..good.scene }, "scene.receivers.min"),
        (Scene { visible_depth: Some(DepthRange { near: 2.0, far: 1.0 }), ..good.scene }, "scene.visible_depth.near"),
        (
            Scene { visible_depth: Some(DepthRange { near: 2.0, far: f64::NAN }), ..good.scene },
            "scene.visible_depth.far",
        ),
    ] {
        assert_eq!(field(&FitInput { scene, ..good }), name);
    }
    for (near, far, name) in [
        (0.0, 1.0, "camera.projection.near"),
        (-1.0, 1.0, "camera.projection.near"),
        (2.0, 1.0, "camera.projection.near"),
        (f64::NAN, 1.0, "camera.projection.near"),
        (1.0, f64::NAN, "camera.projection.far"),
        (1.0, 1e300, "camera.projection.far"),
    ] {
        let camera = Camera::perspective(DMat4::IDENTITY, 0.8, 1.5, near, far);
        assert_eq!(field(&FitInput { camera, ..good }), name, "{near} {far}");
    }
    assert_eq!(field(&FitInput { origin: DVec3::NAN, ..good }), "origin");
}

/// Empty scenes are not errors: no views, and the reason.
#[test]
fn nothing_to_shadow_is_not_an_error() {
    let reason = |scene| {
        let frame = techniques::fsm().fit(&input(scene)).unwrap();
        assert!(frame.views.is_empty());
        whys(&frame)[0].1
    };
    let all = Scene::within(room(30.0));
    assert_eq!(reason(Scene { casters: Aabb::EMPTY, ..all }), Why::NoCasters);
    assert_eq!(reason(Scene { receivers: Aabb::EMPTY, ..all }), Why::NoReceivers);
    let behind = Aabb::new(DVec3::new(-1.0, -1.0, 5.0), DVec3::new(1.0, 1.0, 9.0));
    assert!(matches!(reason(Scene { receivers: behind, ..all }), Why::NoReceiversInView { .. }));
    let below = Aabb::new(DVec3::new(-30.0, -90.0, -30.0), DVec3::new(30.0, -80.0, 30.0));
    assert_eq!(reason(Scene { casters: below, ..all }), Why::NothingCastsHere);
    let hidden = Some(DepthRange { near: 500.0, far: 600.0 });
    assert!(matches!(reason(Scene { visible_depth: hidden, ..all }), Why::OutsideVisibleDepth { .. }));
}

/// Casters behind the eye and outside the frustum that shadow the view are kept.
#[test]
fn a_tower_behind_the_camera_casts() {
    let mut input = input(Scene::within(room(300.0)));
    input.scene.visible_depth = Some(DepthRange { near: 0.1, far: 20.0 });
    input.light = Light::Directional { travel: DVec3::new(0.0, -0.3, -1.0).normalize() };
    let frame = techniques::fsm().fit(&input).unwrap();
    let tower = Aabb::new(DVec3::new(-1.0, 15.0, 60.0), DVec3::new(1.0, 25.0, 62.0));
    let aside = Aabb::new(DVec3::new(80.0, 0.0, -10.0), DVec3::new(82.0, 30.0, -8.0));
    assert!(frame.views[0].cull.may_cast(&tower));
    assert!(!frame.views[0].cull.may_cast(&aside));
}

/// A point 10,000 km out, snapped by a texel of 1e-12: the grid rounded to whole steps of f64,
/// and the window missed the point.
#[test]
fn still_windows_hold_points_far_out() {
    let place = DVec3::new(3e6, 8e6, -5e6);
    let remix = Remix { stabilise: Stabilise::SnapTexels, ..techniques::ssm() };
    for side in [1, 16, 1024] {
        let mut input = input(Scene::within(Aabb::new(place, place)));
        input.map = MapBudget::one(side);
        input.origin = place + 1e-3;
        let frame = remix.fit(&input).unwrap();
        let at = frame.views[0].clip_from_render * (place - input.origin).as_vec3().extend(1.0);
        assert!(at.truncate().abs().max_element() <= 1.0, "{at}");
    }
}

/// A caster 48,000 km from the origin of the world and a few nanometres beside its window: culled, because world
/// positions in f64 are themselves only good to seven nanometres there.
#[test]
fn casters_at_the_rim_far_out_are_kept() {
    let receiver = DVec3::new(-38_113_182.842_577_58, -29_255_358.730_032_906, 25_475_893.878_540_173);
    let travel = DVec3::new(-0.096_357_121_228_578_52, 0.808_199_618_065_447_2, -0.580_972_187_412_966_1);
    let casters = Aabb::new(
        DVec3::new(-38_113_183.843_257_58, -29_255_722.196_625_39, 25_475_892.878_540_173),
        DVec3::new(-38_113_181.843_257_58, -29_254_995.263_440_423, 25_475_894.878_540_173),
    );
    let mut input = input(Scene { casters, receivers: Aabb::new(receiver, receiver), ..Scene::within(casters) });
    input.light = Light::Directional { travel };
    input.map = MapBudget::one(16_384);
    input.origin = DVec3::new(-38_113_182.847_599_69, -29_255_358.731_383_026, 25_475_893.876_291_063);
    for stabilise in [Stabilise::Off, Stabilise::SnapTexels] {
        let frame = Remix { stabilise, ..techniques::ssm() }.fit(&input).unwrap();
        for step in 0..100 {
            let caster = receiver - travel * f64::from(step) * 0.017;
            assert!(frame.views[0].cull.may_cast(&Aabb::new(caster, caster)), "{stabilise:?} {caster}");
        }
    }
}

fn cascade_map() -> MapBudget {
    MapBudget { side: 1024, layers: 4, views: 4 }
}

/// A camera of f32 numbers is as far from rigid as f32 is: depths of its body lay a rounding beyond the visible ones,
/// whose ends then were out of order, and `fit` panicked.
#[test]
fn cameras_of_f32_do_not_panic() {
    let column = |x: f32, y: f32, z: f32| DVec3::new(x.into(), y.into(), z.into()).extend(0.0);
    let world_from_view =
        DMat4::from_cols(column(0.8, 0.0, -0.6), column(0.0, 1.0, 0.0), column(0.6, 0.0, 0.8), glam::DVec4::W);
    let visible_depth = Some(DepthRange { near: 10.0, far: 10.0 });
    let mut input = input(Scene { visible_depth, ..Scene::within(room(100.0)) });
    input.camera.world_from_view = world_from_view;
    input.map = cascade_map();
    for remix in [techniques::cascades(), techniques::smra_plus()] {
        let frame = remix.fit(&input).unwrap();
        assert_eq!(frame.views.len(), 1, "{:?}", frame.left_out);
    }
}

/// "No limit" as the largest f64, and a frustum without end: corners overflowed, the body collapsed onto the near
/// plane, and all shadows were lost without a word.
#[test]
fn visible_depths_beyond_all_worlds_are_refused() {
    let fit = |far: f64| {
        let visible_depth = Some(DepthRange { near: 0.1, far });
        let mut input = input(Scene { visible_depth, ..Scene::within(room(300.0)) });
        input.camera = Camera::perspective(DMat4::IDENTITY, 0.8, 1.5, 0.1, f64::INFINITY);
        techniques::fsm().fit(&input)
    };
    for far in [f64::MAX, 1.1e15] {
        let error = fit(far).unwrap_err();
        assert!(matches!(error, FitError::OutOfRange { field: "scene.visible_depth.far", .. }), "{error}");
        assert!(error.to_string().contains("infinity"), "{error}");
    }
    // What is legal and without end shadows the same receivers.
    let [far, endless] = [1e15, f64::INFINITY].map(|far| fit(far).unwrap().views[0].domain[1]);
    assert!((300.0..310.0).contains(&far) && (300.0..310.0).contains(&endless), "{far} {endless}");
}

/// A map whose blur had changed was said to be unchanged: both blurs read two texels to either side.
#[test]
fn maps_of_another_filter_are_drawn_again() {
    let fit = |encoding, previous: Option<&ShadowFrame>| {
        let remix = Remix { encoding, stabilise: Stabilise::SnapTexels, ..techniques::msm() };
        let scene = Scene { visible_depth: Some(DepthRange { near: 0.1, far: 20.0 }), ..Scene::within(room(300.0)) };
        remix.fit(&FitInput { previous, ..input(scene) }).unwrap()
    };
    let moments = |format, radius, bell, dark| {
        let moments = Moments::new(MomentKind::Hamburger, format);
        Encoding::Moments(Prefilter { moments, radius, bell, dark })
    };
    let of = |radius| moments(MomentFormat::Float32, radius, false, 0.0);
    let [narrow, wide] = [1.6, 2.4].map(|radius| of(Radius::Texels(radius)));
    let content = |from, to| fit(to, Some(&fit(from, None))).views[0].content;
    assert_eq!(content(narrow, narrow), Content::Unchanged);
    assert_eq!(content(narrow, wide), Content::Redraw);
    let [narrow, wide] = [0.02, 0.021].map(|radius| of(Radius::World(radius)));
    assert_eq!((content(narrow, narrow), content(narrow, wide)), (Content::Unchanged, Content::Redraw));
    let [sharp, depths] = [of(Radius::Texels(0.5)), Encoding::Depth(Pcf::Hardware2x2)];
    assert_eq!((content(depths, sharp), content(sharp, depths)), (Content::Redraw, Content::Redraw));
    let bell = moments(MomentFormat::Float32, Radius::Texels(1.0), true, 0.0);
    assert_eq!(content(of(Radius::Texels(1.4)), bell), Content::Redraw);
    // What is read alone changes no texel: how dark it is, and how wide a box of sums.
    let darker = moments(MomentFormat::Float32, Radius::Texels(1.6), false, 0.1);
    assert_eq!(content(of(Radius::Texels(1.6)), darker), Content::Unchanged);
    let [narrow, wide] = [1.6, 2.4].map(|radius| moments(MomentFormat::Summed, Radius::Texels(radius), false, 0.0));
    assert_eq!(content(narrow, wide), Content::Unchanged);
    assert_eq!(content(of(Radius::Texels(1.6)), narrow), Content::Redraw);
}

/// A slope given by hand had what the automatic one does for blurs, and for levels, added to it.
#[test]
fn manual_bias_of_moments_is_what_it_says() {
    let fit = |encoding, slope_texels| {
        let bias = Bias::Manual { depth_world: 0.0, slope_texels, normal_texels: 0.0 };
        let scene = Scene { visible_depth: Some(DepthRange { near: 0.1, far: 20.0 }), ..Scene::within(room(300.0)) };
        Remix { bias, encoding, ..techniques::fsm() }.fit(&input(scene)).unwrap().uniforms.views[0]
    };
    let radius = Radius::Texels(8.0);
    let Encoding::Moments(prefilter) = techniques::msm().encoding else { panic!("msm has moments") };
    for slope in [0.0, 1.0, 2.5] {
        let (depths, moments) =
            (fit(Encoding::default(), slope), fit(Encoding::Moments(Prefilter { radius, ..prefilter }), slope));
        assert_eq!(moments.bias[0], depths.bias[0], "slope {slope}");
        assert_eq!(moments.moments[2], 0.0, "slope {slope}");
    }
}

/// A world radius of 1024 texels was cut to 32 without a word, and so was one of sums to 127.
#[test]
fn blurs_that_are_cut_say_so() {
    let visible_depth = Some(DepthRange { near: 1.0, far: 10.0 });
    let told = |radius, format| {
        let moments = Moments::new(MomentKind::Hamburger, format);
        let prefilter = Prefilter { radius, ..Prefilter::of(moments) };
        let remix = Remix { encoding: Encoding::Moments(prefilter), ..techniques::msm() };
        let scene = Scene { visible_depth, ..Scene::within(room(300.0)) };
        let frame = remix.fit(&FitInput { map: MapBudget::one(2048), ..input(scene) }).unwrap();
        let texel = f64::from(frame.views[0].texel.world[0]);
        let cut = frame.left_out.iter().find(|cut| cut.part == Part::Blur(0));
        cut.map(|cut| match cut.why {
            Why::BlurTooWide { radius } => (radius / texel).round(),
            why => panic!("{why}"),
        })
    };
    let formats = [MomentFormat::Float32, MomentFormat::Summed];
    let wide = formats.map(|format| told(Radius::World(5.0), format).unwrap());
    assert!((wide[0] - 32.0).abs() <= 1.0 && (wide[1] - 127.0).abs() <= 2.0, "{wide:?}");
    assert_eq!(formats.map(|format| told(Radius::World(0.1), format)), [None; 2]);
    assert_eq!(formats.map(|format| told(Radius::Texels(32.0), format)), [None; 2]);
}
