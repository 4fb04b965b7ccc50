//! Bleeding is reduced where casters overlap as the light sees them, and penumbras are left alone elsewhere.

use antumbra::{
    Aabb, Encoding, FitInput, Light, MapBudget, Object, Part, Prefilter, Radius, Remix, Scene, ShadowFrame,
    ShadowTechnique, Why, techniques,
};
use glam::DVec3;

use crate::stage::{SIZE, kinds, tiled};
use crate::support;

/// Share of the light that is taken for bleeding.
const DARK: f32 = 0.25;

/// Half the side of the ground, world units.
const SIDE: f64 = 60.0;

/// A box of a size at a place above the ground.
fn cube(place: DVec3, size: f64) -> Object {
    Object { bounds: Aabb::new(place, place + size), casts: true }
}

fn fit(remix: &Remix, map: MapBudget, objects: &[Object]) -> ShadowFrame {
    let receivers = Aabb::new(DVec3::new(-SIDE, 0.0, -SIDE), DVec3::new(SIDE, 0.0, SIDE));
    let casters = Aabb::new(DVec3::splat(-SIDE), DVec3::splat(SIDE));
    let scene = Scene { casters, receivers, objects, visible_depth: None, visible_points: &[] };
    let (camera, light) = (support::camera(SIZE), Light::Directional { travel: DVec3::NEG_Y });
    remix.fit(&FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None }).unwrap()
}

/// Whether the reduction is left out: the report and the uniforms of all views say the same.
fn left_out(frame: &ShadowFrame, dark: f32) -> bool {
    assert!(!frame.views.is_empty());
    let said =
        |view: u8| frame.left_out.iter().any(|cut| cut.part == Part::Bleeding(view) && cut.why == Why::NothingOverlaps);
    let views: Vec<bool> = (0..frame.views.len())
        .map(|view| {
            let (said, given) = (said(view as u8), frame.uniforms.views[view].moments[0]);
            assert_eq!(given, if said { 0.0 } else { dark }, "view {view}: {:?}", frame.left_out);
            said
        })
        .collect();
    views.iter().all(|said| *said)
}

/// Left out for casters beside each other; not where they lie above one another, where no objects are known, and where
/// they are too many to compare; not said where nothing was to be reduced.
#[test]
fn bleeding_is_reduced_where_casters_overlap() {
    let beside = [cube(DVec3::new(-3.0, 1.0, 0.0), 1.0), cube(DVec3::new(2.0, 4.0, 0.0), 1.0)];
    let above = [beside[0], cube(DVec3::new(-2.5, 4.0, 0.5), 1.0)];
    let ground = Object { bounds: Aabb::new(DVec3::new(-10.0, 0.0, -10.0), DVec3::new(10.0, 0.0, 10.0)), casts: true };
    let many: Vec<_> =
        (0..64).map(|index| cube(DVec3::new(f64::from(index % 8), 0.5, f64::from(index / 8)), 0.1)).collect();
    for moments in kinds() {
        let of = |dark| {
            let prefilter = Prefilter { dark, ..Prefilter::of(moments) };
            Remix { encoding: Encoding::Moments(prefilter), ..techniques::fsm() }
        };
        let reduced = |objects: &[Object]| !left_out(&fit(&of(DARK), MapBudget::one(1024), objects), DARK);
        assert!(!reduced(&beside), "{moments:?}");
        assert!(!reduced(&above[..1]), "{moments:?}: one caster");
        assert!(reduced(&above) && reduced(&many) && reduced(&[]), "{moments:?}");
        // What casts overlaps the ground that it stands over, unless the ground does not cast.
        assert!(reduced(&[beside[0], ground]));
        assert!(!reduced(&[beside[0], Object { casts: false, ..ground }]));
        // What is out of view is no caster of it.
        let away = cube(DVec3::new(-2.5, -59.0, 0.5), 1.0);
        assert!(!reduced(&[beside[0], away]));
        let nothing = fit(&of(0.0), MapBudget::one(1024), &beside);
        assert!(nothing.left_out.iter().all(|cut| cut.part != Part::Bleeding(0)));
    }
}

/// What is blurred together is overlap: a wide blur reaches from one caster to the next.
#[test]
fn wide_blurs_overlap() {
    let beside = [cube(DVec3::new(-3.0, 1.0, 0.0), 1.0), cube(DVec3::new(0.0, 4.0, 0.0), 1.0)];
    let moments = kinds().next().unwrap();
    let left_out = |radius| {
        let prefilter = Prefilter { dark: DARK, radius, ..Prefilter::of(moments) };
        let remix = Remix { encoding: Encoding::Moments(prefilter), ..techniques::fsm() };
        left_out(&fit(&remix, MapBudget::one(1024), &beside), DARK)
    };
    assert!(left_out(Radius::World(0.1)) && !left_out(Radius::World(1.1)));
    assert!(left_out(Radius::Texels(1.5)) && !left_out(Radius::Texels(32.0)));
}

/// Each of several views for itself: those over one caster go without, that over two keeps it.
#[test]
fn views_differ() {
    let prefilter = Prefilter { dark: DARK, ..Prefilter::of(kinds().next().unwrap()) };
    let (remix, map) = tiled(Encoding::Moments(prefilter), 1024);
    // Near the eye, and far from it two above one another.
    let objects = [
        cube(DVec3::new(0.0, 1.0, 0.0), 0.5),
        cube(DVec3::new(-25.0, 1.0, -40.0), 1.0),
        cube(DVec3::new(-25.2, 3.0, -40.2), 1.0),
    ];
    let frame = fit(&remix, map, &objects);
    let dark: Vec<f32> = (0..frame.views.len()).map(|view| frame.uniforms.views[view].moments[0]).collect();
    println!("{dark:?}: {:?}", frame.left_out);
    assert!(dark.contains(&0.0) && dark.contains(&DARK), "{dark:?}");
    assert!(!left_out(&frame, DARK));
}
