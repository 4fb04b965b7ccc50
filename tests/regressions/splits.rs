//! Bugs of several maps, verbatim: the input that showed each, and one sentence.

use antumbra::{
    Camera, DepthRange, DepthSplits, FitInput, Light, MapBudget, Object, Part, Remix, Scene, Scheme, ShadowTechnique,
    Share, Split, Stabilise, Warp, Why, techniques,
};
use glam::{DMat4, DVec3};

use crate::{room, whys};

/// As for one map, with four.
fn input(scene: Scene) -> FitInput {
    FitInput { map: MapBudget { side: 1024, layers: 4, views: 4 }, ..crate::input(scene) }
}

/// Views that do not exist were said to serve: where nothing casts, there is none.
#[test]
fn no_view_serves_where_there_is_none() {
    let objects = [Object { bounds: room(1.0), casts: false }];
    let scene = Scene { objects: &objects, ..Scene::within(room(30.0)) };
    let splits = Split::Depth(DepthSplits::DEFAULT);
    let whole = Remix { split: splits, warp: Warp::Uniform, ..Remix::default() };
    let frame = whole.fit(&input(scene)).unwrap();
    assert_eq!(whys(&frame), [(Part::Light, Why::NothingCastsHere)]);
    // One layer for all maps, the first of which turns out to be one of the whole scene, twice.
    let mut input = input(Scene { objects: &objects, ..Scene::within(room(3.0)) });
    input.camera.world_from_view = DMat4::from_translation(DVec3::new(0.0, 0.0, 30.0));
    input.light = Light::Directional { travel: DVec3::new(0.14, 0.0, -1.0).normalize() };
    input.map = MapBudget { layers: 1, ..input.map };
    for (share, stabilise) in [
        (Share::LeastError, Stabilise::Off),
        (Share::Equal, Stabilise::Off),
        (Share::LeastError, Stabilise::SnapTexels),
    ] {
        let warp = Warp::Focused;
        let splits = Split::Depth(DepthSplits { scheme: Scheme::Uniform, enough: 0.0, ..DepthSplits::DEFAULT });
        let frame = Remix { split: splits, warp, share, stabilise, ..Remix::default() }.fit(&input).unwrap();
        assert!(frame.views.is_empty() && !frame.left_out.is_empty());
        let said = whys(&frame);
        assert!(!said.iter().any(|(_, why)| matches!(why, Why::ServedBy { .. })), "{said:?}");
        // Nor does anything speak of a view.
        assert!(said.iter().all(|(part, _)| matches!(part, Part::Light | Part::Split(_))), "{said:?}");
    }
}

/// Samples of last year, all of them behind the eye: the error of all maps was predicted to be 0.
#[test]
fn stale_samples_do_not_make_maps_perfect() {
    let fit = |visible_points: &[DVec3], visible_depth| {
        let scene = Scene { visible_points, visible_depth, ..Scene::within(room(100.0)) };
        let frame = techniques::cascades().fit(&input(scene)).unwrap();
        assert!(!frame.views.is_empty());
        frame.predicted.error
    };
    let none = fit(&[], None);
    let stale = fit(&[DVec3::new(0.0, 0.0, 50.0)], None);
    assert!(none > 0.0 && (stale / none - 1.0).abs() < 0.2, "{stale}, without samples {none}");
    // Nor do depths without a range.
    assert!(fit(&[], Some(DepthRange { near: 10.0, far: 10.0 })) > 0.0);
}

/// A near plane so close that f64 has no ratio for it: planes were NaN, so that a frame differed from itself.
#[test]
fn the_nearest_near_planes_have_splits() {
    for near in [1e-300, f64::MIN_POSITIVE, 5e-324] {
        let mut input = input(Scene::within(room(2e9)));
        input.camera = Camera::perspective(DMat4::IDENTITY, 0.8, 1.5, near, 1e9);
        let frame = techniques::cascades().fit(&input).unwrap();
        let again = techniques::cascades().fit(&FitInput { previous: Some(&frame), ..input }).unwrap();
        assert!(again == techniques::cascades().fit(&FitInput { previous: Some(&frame), ..input }).unwrap());
        assert!(frame == techniques::cascades().fit(&input).unwrap(), "near {near:e}");
    }
}

/// Shadows that were asked to fade and did not, without a word: over one map, a map of the whole scene, or a share
/// of 0.
#[test]
fn shadows_that_do_not_fade_say_so() {
    let told = |maps, warp, fade, blend| {
        let split = Split::Depth(DepthSplits { maps, fade, blend, ..DepthSplits::DEFAULT });
        let input = input(Scene::within(room(300.0)));
        let frame = Remix { split, warp, ..Remix::default() }.fit(&input).unwrap();
        assert!(!frame.views.is_empty());
        whys(&frame).contains(&(Part::Fade, Why::NothingToFadeOver))
    };
    assert!(
        told(1, Warp::Focused, true, 0.2) && told(4, Warp::Uniform, true, 0.2) && told(4, Warp::Focused, true, 0.0)
    );
    assert!(!told(1, Warp::Focused, false, 0.2) && !told(4, Warp::Focused, true, 0.2));
}
