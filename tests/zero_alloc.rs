//! `fit` allocates nothing, whatever the technique and however it ends.

use std::alloc::System;
use std::sync::atomic::{AtomicUsize, Ordering};

use antumbra::{
    Aabb, Camera, FitInput, Light, MapBudget, Object, Remix, Scene, ShadowTechnique, Share, Stabilise, techniques,
};
use glam::{DMat4, DVec3};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Keeps results alive so that no fit is optimised away.
static KEPT: AtomicUsize = AtomicUsize::new(0);

#[test]
fn fit_allocates_nothing() {
    let room = Aabb::new(DVec3::splat(-30.0), DVec3::splat(30.0));
    let objects: Vec<Object> = (0..50)
        .map(|i| {
            let corner = DVec3::new(f64::from(i) - 25.0, 0.0, 0.0);
            Object { bounds: Aabb::new(corner, corner + 1.0), casts: i % 2 == 0 }
        })
        .collect();
    let scenes = [
        Scene::within(room),
        Scene { objects: &objects, ..Scene::within(room) },
        Scene::within(Aabb::EMPTY),
        Scene { receivers: Aabb::new(DVec3::splat(1e6), DVec3::splat(1e6)), ..Scene::within(room) },
    ];
    let travels = [DVec3::NEG_Y, DVec3::Z, DVec3::new(0.6, -0.8, 0.0), DVec3::ZERO];
    let camera = Camera::perspective(DMat4::IDENTITY, 1.0, 1.5, 0.1, f64::INFINITY);
    let seen: Vec<DVec3> = (1..400).map(|i| DVec3::new(0.1, 0.05, -0.2) * f64::from(i)).collect();
    let region = Region::new(ALLOCATOR);
    let mut fits = 0;
    for (_, technique) in techniques::NAMED {
        // Still maps have no warp to guard.
        for (stabilise, guard, share) in [
            (Stabilise::Off, true, Share::Equal),
            (Stabilise::Off, false, Share::EqualError),
            (Stabilise::SnapTexels, true, Share::Equal),
            (Stabilise::SnapTexels, true, Share::LeastError),
        ] {
            for (scene, visible_points) in scenes.into_iter().flat_map(|scene| [(scene, &[][..]), (scene, &seen)]) {
                for travel in travels {
                    let remix = Remix { stabilise, guard, share, ..technique() };
                    let scene = Scene { visible_points, ..scene };
                    let light = Light::Directional { travel };
                    let map = MapBudget { side: 1024, layers: 2, views: 8 };
                    let input = FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None };
                    let first = remix.fit(&input);
                    let again = remix.fit(&FitInput { previous: first.as_ref().ok(), ..input });
                    let views = again.map_or(9, |frame| frame.views.len());
                    KEPT.fetch_add(views, Ordering::Relaxed);
                    fits += 1;
                }
            }
        }
    }
    let change = region.change();
    assert_eq!((change.allocations, change.reallocations), (0, 0));
    // Working, degenerate and failing fits all took part.
    println!("{fits} fits, 0 allocations");
    assert!(KEPT.load(Ordering::Relaxed) > fits / 4);
    // The counter does count.
    let boxed = std::hint::black_box(Box::new(fits));
    assert!(region.change().allocations > 0, "{boxed}");
}
