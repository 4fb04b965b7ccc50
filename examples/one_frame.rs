//! One frame without a GPU: what goes in, what comes out, and what was left out.
//!
//! `cargo run --example one_frame`

use antumbra::{Aabb, Camera, DepthRange, FitInput, Light, MapBudget, Scene, ShadowTechnique, techniques, wgsl};
use glam::DVec3;

fn main() -> Result<(), antumbra::FitError> {
    // The camera: where it stands, what it looks at, and its lens. 60 degrees, full HD, near 0.1, far 500.
    let eye = DVec3::new(4.0, 1.8, 12.0);
    let world_from_view = Camera::look_at(eye, DVec3::new(0.0, 1.0, 0.0), DVec3::Y);
    let camera = Camera::perspective(world_from_view, 60.0_f64.to_radians(), 16.0 / 9.0, 0.1, 500.0);
    // The light: the direction in which it travels.
    let light = Light::Directional { travel: DVec3::new(-0.4, -1.0, -0.3).normalize() };
    // The scene: bounds are enough. Shadows are wanted up to 60 units from the eye.
    let bounds = Aabb::new(DVec3::new(-40.0, 0.0, -40.0), DVec3::new(40.0, 15.0, 40.0));
    let visible_depth = Some(DepthRange { near: 0.1, far: 60.0 });
    let scene = Scene { visible_depth, ..Scene::within(bounds) };
    // The texels that may be used, and the origin of the space of all matrices below.
    let input = FitInput { camera, light, scene, map: MapBudget::one(2048), origin: eye, previous: None };

    // The fit: pure, no allocation, microseconds.
    let technique = techniques::fsm();
    let frame = technique.fit(&input)?;

    for (index, view) in frame.views.iter().enumerate() {
        println!("view {index}: draw casters into {} of layer {}", view.viewport, view.layer);
        println!("clip_from_render, row by row (render = world - {eye}):");
        for row in view.clip_from_render.transpose().to_cols_array_2d() {
            println!("  {:>12.6} {:>12.6} {:>12.6} {:>12.6}", row[0], row[1], row[2], row[3]);
        }
        let [small, large] = view.texel.world;
        println!("a texel is {small:.4} x {large:.4} units, at most {:.1} pixels", view.texel.pixels.max);
        let tower = Aabb::new(DVec3::new(5.0, 0.0, 13.0), DVec3::new(9.0, 12.0, 17.0));
        let house = Aabb::new(DVec3::new(-2.0, 0.0, 300.0), DVec3::new(2.0, 4.0, 304.0));
        let casts = |bounds| view.cull.may_cast(bounds);
        println!(
            "may a tower behind the camera cast into it? {}; a house 300 units off? {}",
            casts(&tower),
            casts(&house)
        );
    }
    println!("left out:");
    for cut in &frame.left_out {
        println!("  {cut}");
    }
    // The shader text for these uniforms, once per change of options: paste it in front of the engine's own.
    let text = wgsl::module(technique.wgsl_key(), wgsl::Bindings { group: 2, first: 0 });
    println!("shader: {} lines, ends with", text.lines().count());
    for line in text.lines().skip_while(|line| !line.starts_with("@group")) {
        println!("  {line}");
    }
    Ok(())
}
