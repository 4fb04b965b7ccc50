//! Nanoseconds per fit, for each technique and kind of scene. `cargo bench --bench fit`.

use antumbra::{
    Aabb, Camera, DepthSplits, FitInput, Focus, Light, MapBudget, Object, Remix, Scene, Scheme, ShadowTechnique, Split,
    Stabilise, Warp, techniques,
};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use std::hint::black_box;

/// Scenes by the work they cause: a body that fills the frustum, one that is cut on all sides, many objects.
fn inputs(objects: &[Object]) -> [(&'static str, FitInput<'_>); 3] {
    let camera = |eye: DVec3, target: DVec3, far: f64| {
        Camera::perspective(Camera::look_at(eye, target, DVec3::Y), 45_f64.to_radians(), 4.0 / 3.0, 1.0, far)
    };
    let sun = Light::Directional { travel: DVec3::new(0.4, -0.8, 0.3).normalize() };
    let map = MapBudget { side: 2048, layers: 4, views: 4 };
    let origin = DVec3::ZERO;
    let forest = Aabb::new(DVec3::new(-20.0, 0.0, -20.0), DVec3::new(20.0, 9.0, 20.0));
    let city = Aabb::new(DVec3::new(-1400.0, 0.0, -1400.0), DVec3::new(1400.0, 180.0, 1400.0));
    let ground = camera(DVec3::new(0.0, 2.2, 20.5), DVec3::new(0.0, 3.6, 0.0), 50.0);
    let above = camera(DVec3::new(-620.0, 300.0, 760.0), DVec3::ZERO, 5000.0);
    let input = |camera, scene| FitInput { camera, light: sun, scene, map, origin, previous: None };
    [
        ("forest", input(ground, Scene::within(forest))),
        ("city", input(above, Scene::within(city))),
        ("city-300-objects", input(above, Scene { objects, ..Scene::within(city) })),
    ]
}

fn fit(criterion: &mut Criterion) {
    let objects: Vec<Object> = (0..300)
        .map(|i| {
            let corner = DVec3::new(f64::from(i % 20) * 140.0 - 1400.0, 0.0, f64::from(i / 20) * 180.0 - 1400.0);
            Object { bounds: Aabb::new(corner, corner + DVec3::new(60.0, 90.0, 60.0)), casts: true }
        })
        .collect();
    let mut group = criterion.benchmark_group("fit");
    for (scene, input) in inputs(&objects) {
        for (name, technique) in techniques::NAMED {
            for (suffix, stabilise) in [("", Stabilise::Off), ("-snapped", Stabilise::SnapTexels)] {
                let remix = Remix { stabilise, ..technique() };
                // A row that fits nothing would time nothing.
                let frame = remix.fit(&input).expect("legal input");
                let maps = usize::from(remix.wgsl_key().maps);
                assert!((1..=maps).contains(&frame.views.len()), "{name} {scene}: {:?}", frame.left_out);
                group.bench_function(BenchmarkId::new(format!("{name}{suffix}"), scene), |bencher| {
                    bencher.iter(|| remix.fit(black_box(&input)));
                });
            }
        }
    }
    for (scene, input) in inputs(&objects) {
        for (name, warp, stabilise) in [
            ("trapezoid", Warp::Trapezoidal { focus: Focus::default() }, Stabilise::Off),
            ("focused", Warp::Focused, Stabilise::Off),
            ("sphere-snapped", Warp::Focused, Stabilise::SnapTexels),
        ] {
            let scheme = Scheme::Practical { lambda: 0.5, offset: 0.0 };
            let split = Split::Depth(DepthSplits { maps: 4, scheme, ..DepthSplits::DEFAULT });
            let remix = Remix { split, warp, stabilise, ..Remix::default() };
            assert!(remix.fit(&input).is_ok_and(|frame| frame.views.len() > 1));
            group.bench_function(BenchmarkId::new(format!("4-splits-{name}"), scene), |bencher| {
                bencher.iter(|| remix.fit(black_box(&input)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, fit);
criterion_main!(benches);
