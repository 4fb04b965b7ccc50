//! The table of conventions in `lib.rs`, a test per row: each pushes a point through.

use antumbra::{
    Aabb, Camera, Content, CullVolume, FitError, FitInput, Light, MapBudget, Scene, ShadowFrame, ShadowTechnique,
    ShadowView, WgslKey, techniques,
};
use glam::{DMat4, DVec3, DVec4, Mat4, UVec4, Vec2, Vec3, Vec4, Vec4Swizzles};

const TRAVEL: DVec3 = DVec3::new(0.6, -0.8, 0.0);

fn fit(origin: DVec3, shift: DVec3) -> ShadowFrame {
    let eye = Camera::look_at(DVec3::new(0.0, 2.0, 18.0) + shift, DVec3::new(0.0, 3.0, 0.0) + shift, DVec3::Y);
    let input = FitInput {
        camera: Camera::perspective(eye, 0.8, 1.5, 0.1, 100.0),
        light: Light::Directional { travel: TRAVEL },
        scene: Scene::within(Aabb::new(DVec3::new(-20.0, 0.0, -20.0) + shift, DVec3::new(20.0, 9.0, 20.0) + shift)),
        map: MapBudget::one(1024),
        origin,
        previous: None,
    };
    techniques::fsm().fit(&input).expect("legal input")
}

fn here() -> ShadowFrame {
    fit(DVec3::ZERO, DVec3::ZERO)
}

fn clip(frame: &ShadowFrame, position: Vec3) -> Vec4 {
    frame.views[0].clip_from_render * position.extend(1.0)
}

#[test]
fn view_space_is_right_handed_and_looks_along_minus_z() {
    let world_from_view = Camera::look_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y);
    assert!((world_from_view * DVec4::new(0.0, 0.0, -5.0, 1.0) - DVec4::W).length() < 1e-12);
    assert!((world_from_view * DVec4::X - DVec4::X).length() < 1e-12);
    assert!((world_from_view * DVec4::Y - DVec4::Y).length() < 1e-12);
}

#[test]
fn any_direction_may_be_up() {
    // The same scene with z up: rotate everything, and the texels have the same size.
    let turn = glam::DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let frame = |world_from_world: glam::DMat4| {
        let eye = Camera::look_at(DVec3::new(0.0, 2.0, 18.0), DVec3::new(0.0, 3.0, 0.0), DVec3::Y);
        let corners = [DVec3::new(-20.0, 0.0, -20.0), DVec3::new(20.0, 9.0, 20.0)];
        let input = FitInput {
            camera: Camera::perspective(world_from_world * eye, 0.8, 1.5, 0.1, 100.0),
            light: Light::Directional { travel: world_from_world.transform_vector3(TRAVEL) },
            scene: Scene::within(Aabb::around(corners.map(|corner| world_from_world.transform_point3(corner)))),
            map: MapBudget::one(1024),
            origin: DVec3::ZERO,
            previous: None,
        };
        techniques::fsm().fit(&input).expect("legal input")
    };
    let (y_up, z_up) = (frame(glam::DMat4::IDENTITY), frame(turn));
    assert!((y_up.views[0].texel.world[1] - z_up.views[0].texel.world[1]).abs() < 1e-4 * y_up.views[0].texel.world[1]);
}

#[test]
fn render_space_is_world_minus_origin() {
    let origin = DVec3::new(1e7, -2e6, 3e7);
    let (near, far) = (here(), fit(origin, origin));
    for point in [Vec3::ZERO, Vec3::new(3.0, 1.0, -4.0)] {
        assert!((clip(&near, point) - clip(&far, point)).length() < 1e-5);
    }
}

#[test]
fn column_vectors() {
    // The translation is in the last column, and positions stand on the right.
    let frame = here();
    let at_zero = clip(&frame, Vec3::ZERO);
    assert_eq!(at_zero, frame.views[0].clip_from_render.w_axis);
}

#[test]
fn clip_depth_is_zero_nearest_to_the_light() {
    let frame = here();
    let towards_sun = clip(&frame, Vec3::new(0.0, 4.0, 0.0) - TRAVEL.as_vec3());
    let away = clip(&frame, Vec3::new(0.0, 4.0, 0.0) + TRAVEL.as_vec3());
    assert!(towards_sun.z < away.z);
    assert!((0.0..=1.0).contains(&towards_sun.z) && (0.0..=1.0).contains(&away.z));
    // Light moves neither x nor y.
    assert!((towards_sun.xy() - away.xy()).length() < 1e-5);
}

#[test]
fn texture_coordinates_have_row_zero_on_top() {
    let frame = here();
    let uniforms = &frame.uniforms.views[0];
    for point in [Vec3::ZERO, Vec3::new(3.0, 1.0, -4.0), Vec3::new(-6.0, 5.0, 2.0)] {
        let at = clip(&frame, point);
        let row = |row: [f32; 4]| Vec4::from_array(row).dot(point.extend(1.0));
        let uv = Vec2::new(row(uniforms.u_from_render), row(uniforms.v_from_render));
        // Within the viewport.
        let viewport = frame.views[0].viewport.as_vec4() / 1024.0;
        let expected = viewport.xy() + Vec2::new(0.5 * at.x + 0.5, 0.5 - 0.5 * at.y) * viewport.zw();
        assert!((uv - expected).length() < 1e-6);
    }
}

#[test]
fn depth_is_linear_and_equals_clip_z() {
    let frame = here();
    let row = frame.views[0].depth_from_render;
    let depth = |point: Vec3| row.dot(point.extend(1.0));
    let (a, b) = (Vec3::new(-3.0, 1.0, 2.0), Vec3::new(5.0, 7.0, -2.0));
    assert!((depth(a.midpoint(b)) - 0.5 * (depth(a) + depth(b))).abs() < 1e-6);
    assert!((depth(a) - clip(&frame, a).z).abs() < 1e-6);
    // The shader's row is the same, less a constant bias of some roundings.
    let biased = Vec4::from_array(frame.uniforms.views[0].depth_from_render);
    assert_eq!(row.truncate(), biased.truncate());
    assert!((1e-7..1e-5).contains(&(row.w - biased.w)), "{}", row.w - biased.w);
}

#[test]
fn travel_is_the_way_light_goes() {
    // Of two points on one ray, the one further along `travel` is the deeper one.
    let frame = here();
    let row = frame.views[0].depth_from_render.truncate();
    assert!(row.normalize().dot(TRAVEL.as_vec3()) > 0.999_999);
}

#[test]
fn winding_is_kept() {
    // Counter-clockwise seen from the light: its normal points towards the light.
    let towards = -TRAVEL.as_vec3();
    let right = towards.any_orthonormal_vector();
    let up = towards.cross(right);
    let frame = here();
    let [a, b, c] = [Vec3::ZERO, right, up].map(|point| clip(&frame, point).xy());
    assert!((b - a).perp_dot(c - a) > 0.0);
}

#[test]
fn angles_are_radians_and_lengths_world_units() {
    let camera = Camera::perspective(glam::DMat4::IDENTITY, std::f64::consts::FRAC_PI_2, 2.0, 0.1, 10.0);
    let antumbra::Projection::Perspective { left, right, down, up, .. } = camera.projection else {
        panic!("perspective")
    };
    for (tangent, expected) in [(up, 1.0), (down, -1.0), (right, 2.0), (left, -2.0)] {
        assert!((tangent - expected).abs() < 1e-12);
    }
    // A texel of a window as wide as the scene is a 1024th of it, give or take the border.
    let texel = here().views[0].texel.world[1];
    assert!((0.01..0.06).contains(&texel), "{texel}");
}

#[test]
fn narrowed_once_relative_to_origin() {
    // Ten thousand kilometres out, with the origin at the eye, matrices are as good as at home.
    let far = DVec3::new(1e7, 0.0, 1e7);
    let (near, away) = (here(), fit(far, far));
    for (a, b) in
        near.views[0].clip_from_render.to_cols_array().into_iter().zip(away.views[0].clip_from_render.to_cols_array())
    {
        assert!((a - b).abs() <= 1e-6 * (1.0 + a.abs()), "{a} {b}");
    }
}

/// A technique from outside of the crate: one map that an engine has laid itself, made of what is public alone.
struct Outside;

impl ShadowTechnique for Outside {
    fn fit(&self, input: &FitInput) -> Result<ShadowFrame, FitError> {
        let mut frame = ShadowFrame::lit(self.wgsl_key(), input.map);
        let clip_from_render = Mat4::from_scale(Vec3::splat(0.1));
        let cull = CullVolume::new(input.origin, &[DVec4::new(0.0, 1.0, 0.0, 10.0)]);
        let viewport = UVec4::new(1, 1, input.map.side - 2, input.map.side - 2);
        frame.views.push(ShadowView::new(clip_from_render, clip_from_render.row(2), viewport, 0, cull));
        frame.uniforms.views[0].u_from_render = [0.05, 0.0, 0.0, 0.5];
        frame.uniforms.counts[0] = 1;
        Ok(frame)
    }

    fn wgsl_key(&self) -> WgslKey {
        WgslKey::default()
    }
}

#[test]
fn anyone_can_implement_a_technique() {
    let technique: &dyn ShadowTechnique = &Outside;
    let input = FitInput {
        camera: Camera::perspective(DMat4::IDENTITY, 1.0, 1.0, 0.1, 100.0),
        light: Light::Directional { travel: DVec3::NEG_Y },
        scene: Scene::within(Aabb::new(DVec3::splat(-9.0), DVec3::splat(9.0))),
        map: MapBudget::one(64),
        origin: DVec3::ZERO,
        previous: None,
    };
    let first = technique.fit(&input).unwrap();
    assert!(first.views[0].cull.may_cast(&Aabb::new(DVec3::splat(-1.0), DVec3::splat(1.0))));
    assert!(!first.views[0].cull.may_cast(&Aabb::new(DVec3::splat(-30.0), DVec3::splat(-20.0))));
    // It may be the history of another one, which draws its own map.
    let next = techniques::fsm().fit(&FitInput { previous: Some(&first), ..input }).unwrap();
    assert_eq!(next.views[0].content, Content::Redraw);
    assert_eq!(next.views[0].viewport, first.views[0].viewport);
}
