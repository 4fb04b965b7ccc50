//! Soft shadows: as wide as the light and the distance to the caster say, in world units, whatever map shows them.

use antumbra::encoding::depth::DepthMap;
use antumbra::encoding::split::antumbra_visibility_noisy;
use antumbra::lab::raster::{DepthMode, DepthTarget, RasterPass, rasterise};
use antumbra::lab::scene::{SOLID, SceneModel};
use antumbra::warp::Warp;
use antumbra::{
    Aabb, Camera, DepthLaw, DepthSplits, Encoding, FitError, FitInput, Light, MapBudget, Part, Pcf, Remix, SUN_ANGLE,
    Scene, Select, ShadowFrame, ShadowTechnique, Split, Why,
};
use glam::{DVec2, DVec3, UVec2, Vec3};

/// Angular diameter of the light, radians: nearly twice the sun's.
const ANGLE: f32 = 0.016;

/// Half the width of the pole, world units: more than any penumbra here.
const HALF: f64 = 1.5;

/// Light falls at 45 degrees: what stands at height h shades the ground h behind it, at a distance of h √2.
fn travel() -> DVec3 {
    DVec3::new(0.0, -1.0, -1.0).normalize()
}

/// The ground, and a flat pole that stands on it and faces the light.
fn model() -> SceneModel {
    let mut model = SceneModel::default();
    let ground = [DVec3::new(-20.0, 0.0, 5.0), DVec3::X * 40.0, DVec3::Z * -40.0];
    let pole = [DVec3::new(-HALF, 0.0, 0.0), DVec3::X * 2.0 * HALF, DVec3::Y * 30.0];
    for [corner, side, other] in [ground, pole] {
        let first = model.positions.len() as u32;
        model.positions.extend([corner, corner + side, corner + side + other, corner + other]);
        model.uvs.extend([DVec2::ZERO; 4]);
        model.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        model.triangle_cutout.extend([SOLID; 2]);
    }
    model
}

fn camera() -> Camera {
    Camera::perspective(
        Camera::look_at(DVec3::new(0.0, 12.0, 12.0), DVec3::new(0.0, 0.0, -12.0), DVec3::Y),
        0.9,
        1.5,
        1.0,
        80.0,
    )
}

fn input(side: u32, maps: u32) -> FitInput<'static> {
    FitInput {
        camera: camera(),
        light: Light::Directional { travel: travel() },
        scene: Scene::within(Aabb::new(DVec3::new(-20.0, 0.0, -35.0), DVec3::new(20.0, 30.0, 5.0))),
        map: MapBudget { side, layers: maps, views: maps },
        origin: DVec3::ZERO,
        previous: None,
    }
}

/// A frame, and its maps.
struct Drawn {
    frame: ShadowFrame,
    layers: Vec<Vec<f32>>,
}

impl Drawn {
    fn new(remix: &Remix, side: u32) -> Self {
        let maps = u32::from(remix.wgsl_key().maps);
        let frame = remix.fit(&input(side, maps)).unwrap();
        let model = model();
        let side = side as usize;
        let mut layers = vec![vec![1.0; side * side]; maps as usize];
        for view in &frame.views {
            let [left, top, width, height] = view.viewport.to_array();
            let mut target = DepthTarget::new(width, height, DepthMode::LessEqual);
            let depth_from_render = frame.wgsl.shape.writes_depth().then_some(view.depth_from_render);
            let pass = RasterPass { clip_from_render: view.clip_from_render, depth_from_render, origin: DVec3::ZERO };
            rasterise(&mut target, &model, core::slice::from_ref(&(0..model.triangles.len())), &pass);
            for (row, depths) in target.depth.chunks_exact(width as usize).enumerate() {
                let start = (top as usize + row) * side + left as usize;
                layers[view.layer as usize][start..start + depths.len()].copy_from_slice(depths);
            }
        }
        Self { frame, layers }
    }

    /// Light at a point of the ground, averaged over turns of the disc.
    fn lit(&self, at: DVec3) -> f64 {
        const TURNS: u16 = 32;
        let size = UVec2::splat(self.frame.map.side);
        let maps: Vec<_> = self.layers.iter().map(|depth| DepthMap { size, depth }).collect();
        let eye_depth = camera().world_from_view.inverse().transform_point3(at).z as f32;
        let eye_depth = -eye_depth;
        let lit = |turn: u16| {
            let noise = f32::from(turn) / f32::from(TURNS);
            let (key, uniforms) = (self.frame.wgsl, &self.frame.uniforms);
            antumbra_visibility_noisy(key, uniforms, &maps, at.as_vec3(), Vec3::Y, eye_depth, noise)
        };
        (0..TURNS).map(|turn| f64::from(lit(turn))).sum::<f64>() / f64::from(TURNS)
    }

    /// Width of the penumbra along the right edge of the pole's shadow, `behind` the pole: that of a disc whose shadow
    /// has the deviation that was found.
    fn width(&self, behind: f64) -> f64 {
        const STEPS: i32 = 240;
        let reach = 1.0;
        let place = |step: f64| reach * (2.0 * step / f64::from(STEPS) - 1.0);
        let lit = |step: i32| self.lit(DVec3::new(HALF + place(f64::from(step)), 0.0, -behind));
        let light: Vec<f64> = (0..=STEPS).map(lit).collect();
        assert!(light[0] < 0.01 && light[STEPS as usize] > 0.99, "{behind}: {light:?}");
        // Light that comes in from step to step, as a distribution.
        let steps = || light.windows(2).enumerate().map(|(step, pair)| (place(step as f64 + 0.5), pair[1] - pair[0]));
        let mean: f64 = steps().map(|(at, more)| at * more).sum();
        let variance: f64 = steps().map(|(at, more)| (at - mean) * (at - mean) * more).sum();
        // An edge at the mean of a disc has half its radius as deviation.
        4.0 * variance.max(0.0).sqrt()
    }

    /// Largest side of a texel, world units.
    fn texel(&self) -> f64 {
        f64::from(self.frame.views.iter().fold(0.0, |largest: f32, view| largest.max(view.texel.world[1])))
    }
}

/// Where widths are measured: distances behind the pole, world units.
const BEHIND: [f64; 5] = [6.0, 10.0, 14.0, 18.0, 22.0];

/// Relative error of a width that may be.
const TOLERANCE: f64 = 0.2;

fn expected(behind: f64) -> f64 {
    2.0 * (0.5 * f64::from(ANGLE)).tan() * behind * core::f64::consts::SQRT_2
}

fn soft(warp: Warp, depth: DepthLaw, split: Split) -> Remix {
    Remix { encoding: Encoding::Soft { angle: ANGLE }, warp, depth, split, ..Remix::default() }
}

/// A penumbra is as wide as the distance times the light's angle, in every kind of map and of every size.
#[test]
fn penumbras_grow_with_the_distance() {
    let three = |select| Split::Depth(DepthSplits { maps: 3, select, enough: 0.0, ..DepthSplits::DEFAULT });
    for (name, remix, side) in [
        ("focused 2048", soft(Warp::Focused, DepthLaw::Linear, Split::One), 2048),
        ("focused 1024", soft(Warp::Focused, DepthLaw::Linear, Split::One), 1024),
        ("warped, linear", soft(Warp::Fixed { strength: 1.0 }, DepthLaw::Linear, Split::One), 2048),
        ("warped, projective", soft(Warp::Fixed { strength: 1.0 }, DepthLaw::Projective, Split::One), 2048),
        ("splits by depth", soft(Warp::Focused, DepthLaw::Linear, three(Select::Depth)), 1024),
        ("splits by containment", soft(Warp::Focused, DepthLaw::Linear, three(Select::Finest)), 1024),
    ] {
        let drawn = Drawn::new(&remix, side);
        assert_eq!(drawn.frame.views.len() > 1, remix.split != Split::One, "{name}");
        let widths = BEHIND.map(|behind| drawn.width(behind));
        let shares: Vec<_> = BEHIND.iter().zip(widths).map(|(behind, width)| width / expected(*behind)).collect();
        println!("{name}, texels up to {:.4}: {widths:.3?}, over expected {shares:.3?}", drawn.texel());
        for (behind, width) in BEHIND.into_iter().zip(widths) {
            let expected = expected(behind);
            assert!((width / expected - 1.0).abs() < TOLERANCE, "{name}, {behind} behind: {width}, not {expected}");
        }
        // A contact is as sharp as texels are.
        let contact = drawn.width(0.25);
        assert!(contact < 4.0 * drawn.texel(), "{name}: {contact} at the contact");
    }
}

/// Where a filter does not reach as far as penumbras, the report says from where on; and angles that no light has are
/// refused.
#[test]
fn what_is_too_wide_is_said() {
    let remix = Remix { encoding: Encoding::Soft { angle: 0.5 }, warp: Warp::Focused, ..Remix::default() };
    let frame = remix.fit(&input(2048, 1)).unwrap();
    let cut = frame.left_out.iter().find(|cut| cut.part == Part::Penumbra(0)).unwrap();
    let Why::PenumbraTooWide { apart } = cut.why else { panic!("{cut}") };
    let texel = f64::from(frame.views[0].texel.world[0]);
    assert!((apart * 0.25_f64.tan() / texel - 16.0).abs() < 1e-3, "{apart}");
    let none = Remix { encoding: Encoding::Soft { angle: 0.0 }, ..remix }.fit(&input(2048, 1)).unwrap();
    assert!(none.left_out.iter().all(|cut| cut.part != Part::Penumbra(0)));
    for angle in [-0.1, 0.6, f32::NAN] {
        let refused = Remix { encoding: Encoding::Soft { angle }, ..remix }.fit(&input(2048, 1));
        assert!(matches!(
            refused,
            Err(FitError::OutOfRange { field: "encoding.angle", .. }
                | FitError::NotFinite { field: "encoding.angle", .. })
        ));
    }
    // Without an angle the light is the sun.
    let [sun, same] = [Encoding::Depth(Pcf::Pcss), Encoding::Soft { angle: SUN_ANGLE }]
        .map(|encoding| Remix { encoding, ..remix }.fit(&input(2048, 1)).unwrap());
    assert_eq!(sun, same);
}
