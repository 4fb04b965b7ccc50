//! Biases on the software renderer: without one surfaces shadow themselves, the automatic one leaves next to nothing of
//! it, a constant and a slope do what their units say, and maps of back faces need none on the lit side.

mod support;

use antumbra::encoding::depth::antumbra_look;
use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::case::{Case, CaseCamera};
use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::gpu::{Gpu, GpuScene, RenderOptions, Renderer};
use antumbra::lab::metrics::detachment::{Detachment, contacts, detachment};
use antumbra::lab::metrics::{Scores, mask_from_bytes};
use antumbra::lab::shapes::MeshBuilder;
use antumbra::lab::subject::{Setting, Subject};
use antumbra::lab::truth::Truth;
use antumbra::{Bias, DepthLaw, Encoding, MapShape, Pcf, Remix, ShadowFrame, ShadowTechnique, Warp, techniques};
use glam::{DMat3, DVec2, DVec3, Vec4};

const NONE: Bias = Bias::Manual { depth_world: 0.0, slope_texels: 0.0, normal_texels: 0.0 };

/// A box and a ball on the ground, seen from the side that the sun does not reach.
struct Studio {
    subject: Subject,
    backs: Subject,
    case: Case,
    truth: Truth,
    visible: Visible,
}

impl Studio {
    fn new() -> Self {
        let mut mesh = MeshBuilder::new("box and ball");
        mesh.terrain(DVec2::splat(-12.0), DVec2::splat(12.0), [4, 4], |_, _| 0.0);
        mesh.end_object();
        mesh.aligned_box(DVec3::new(-1.0, -0.5, -1.0), DVec3::new(1.0, 2.0, 1.0));
        mesh.end_object();
        mesh.ellipsoid(DVec3::new(1.0, 0.9, -3.5), DVec3::ONE, &DMat3::IDENTITY, [48, 24], |_| 1.0);
        let subject = Subject::new(mesh.finish());
        let travel = DVec3::new(1.0, -0.8, -0.3).normalize();
        let camera = CaseCamera {
            eye: DVec3::new(7.0, 5.0, 6.0),
            target: DVec3::new(0.5, 0.5, -1.0),
            up: DVec3::Y,
            fov_y_deg: 50.0,
            near: 0.5,
            far: 60.0,
        };
        let case = support::case_over(camera, travel, [240, 180]);
        let truth = Truth::trace(&case, &subject.model, &|| {});
        let setting = Setting::of(&case);
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        Self { backs: subject.back_faces(travel), subject, case, truth, visible }
    }

    fn fit(&self, remix: &Remix) -> ShadowFrame {
        remix.fit(&Setting::of(&self.case).input(&self.subject, &[], remix.wgsl_key(), 256)).unwrap()
    }

    fn shoot(&self, remix: &Remix, casters: &Subject) -> (Scores, Detachment) {
        let mask = cpu::render(casters, &self.visible, &self.fit(remix), &Setting::of(&self.case)).mask;
        let mask = mask_from_bytes(&mask);
        let found = contacts(&self.case, &self.truth);
        assert!(found.len() > 20, "{} contacts", found.len());
        (Scores::new(&mask, &self.truth).unwrap(), detachment(&mask, &self.truth, &found).unwrap())
    }
}

#[test]
fn acne_and_detachment_are_what_biases_trade() {
    let studio = Studio::new();
    for (warp, depth) in [
        (Warp::Focused, DepthLaw::Linear),
        (Warp::Fixed { strength: 4.0 }, DepthLaw::Linear),
        (Warp::Fixed { strength: 4.0 }, DepthLaw::Projective),
    ] {
        let shoot = |bias| studio.shoot(&Remix { warp, depth, bias, ..techniques::fsm() }, &studio.subject);
        let manual = |depth_world, slope_texels| Bias::Manual { depth_world, slope_texels, normal_texels: 0.0 };
        let (none, _) = shoot(NONE);
        let (automatic, close) = shoot(Bias::Automatic);
        assert!(none.false_interior > 0.1, "{warp:?} {depth:?}: {}", none.false_interior);
        assert!(automatic.false_interior < 2e-4, "{warp:?} {depth:?}: {}", automatic.false_interior);
        assert!(close.mean_px < 1.5, "{warp:?} {depth:?}: {close:?}");
        // As far as the box is high, the shadow is gone.
        let (gone, far) = shoot(manual(4.0, 0.0));
        assert!(gone.false_interior == 0.0 && gone.leak_interior > 0.01, "{}", gone.leak_interior);
        assert!(far.share > 0.99 && far.mean_px > 10.0, "{far:?}");
        // Slopes take acne away, more of them more.
        let [some, enough] = [0.15, 1.5].map(|slope| shoot(manual(0.0, slope)).0.false_interior);
        assert!(none.false_interior > some && some > enough, "{} {some} {enough}", none.false_interior);
    }
}

/// Front faces are what shadows itself; without them, the lit side of closed solids and the ground are clean.
#[test]
fn back_faces_need_no_bias_on_the_lit_side() {
    let studio = Studio::new();
    let remix = Remix { bias: NONE, ..techniques::fsm() };
    let (front, _) = studio.shoot(&remix, &studio.subject);
    let (back, close) = studio.shoot(&remix, &studio.backs);
    assert!(back.false_interior < 0.05 * front.false_interior, "{} {}", back.false_interior, front.false_interior);
    assert!(back.leak_interior < 0.01 && close.mean_px < 2.0, "{} {close:?}", back.leak_interior);
    let (all, backs) = (&studio.subject.model, &studio.backs.model);
    assert_eq!(backs.objects.len(), all.objects.len());
    assert!(backs.objects[0].is_empty(), "the ground faces the light");
    assert_eq!(backs.objects[1].len(), 6, "three of the box's six sides");
}

/// Culling front faces on an adapter leaves the casters that `Subject::back_faces` does, in maps of every shape.
#[test]
fn adapters_cull_what_the_software_renderer_leaves_out() {
    let Ok(gpu) = Gpu::new() else { return eprintln!("skipped: no adapter") };
    let studio = Studio::new();
    let setting = Setting::of(&studio.case);
    let scene = GpuScene::upload(&gpu, &studio.subject.model, setting.origin).unwrap();
    for (warp, depth) in [(Warp::Focused, DepthLaw::Linear), (Warp::Fixed { strength: 4.0 }, DepthLaw::Linear)] {
        let frame = studio.fit(&Remix { warp, depth, ..techniques::fsm() });
        let descriptor = ShadowMapsDescriptor { label: None, key: frame.wgsl, map: frame.map };
        let maps = ShadowMaps::new(gpu.device(), &descriptor).unwrap();
        let draw = |renderer: Renderer| {
            renderer.render(&gpu, &scene, &setting.camera, &frame, &maps, &RenderOptions::default()).unwrap().mask
        };
        let (backs, both) = (draw(Renderer::of_back_faces(&gpu, frame.wgsl)), draw(Renderer::new(&gpu, frame.wgsl)));
        let software = |casters| cpu::render(casters, &studio.visible, &frame, &setting).mask;
        let (expected, not) = (software(&studio.backs), software(&studio.subject));
        let differ = |a: &[u8], b: &[u8]| (0..a.len()).filter(|at| a[*at].abs_diff(b[*at]) > 128).count();
        let (same, other) = (differ(&backs, &expected), differ(&backs, &not));
        assert!(differ(&both, &not) < 10, "{warp:?}: {}", differ(&both, &not));
        assert!(same < 10 && other > 3 * same.max(10), "{warp:?}: {same} pixels, {other} from front faces");
    }
}

/// A slope of k texels lifts a receiver by what its plane falls over k texels in u and in v, along the light; a constant
/// by itself; whatever the filter's own reach is.
#[test]
fn manual_biases_have_their_units() {
    let studio = Studio::new();
    let normal = DVec3::new(-0.5, 0.7, 0.2).normalize();
    let at = DVec3::new(0.3, 0.2, -0.4) - studio.case.camera.eye;
    for filter in [Pcf::Point, Pcf::Hardware2x2] {
        let depth = |bias| {
            let remix = Remix { bias, encoding: Encoding::Depth(filter), ..techniques::fsm() };
            let frame = studio.fit(&remix);
            assert_eq!(frame.wgsl.shape, MapShape::Affine);
            let look = antumbra_look(frame.wgsl, &frame.uniforms.views[0], at.as_vec3(), normal.as_vec3());
            (f64::from(look.depth), frame)
        };
        let manual = |depth_world, slope_texels| Bias::Manual { depth_world, slope_texels, normal_texels: 0.0 };
        let (bare, frame) = depth(manual(0.0, 0.0));
        let view = &frame.uniforms.views[0];
        let [u, v, z] = [view.u_from_render, view.v_from_render, view.depth_from_render]
            .map(|row| Vec4::from_array(row).truncate().as_dvec3());
        // How much depth changes along the plane over a texel step in u and in v.
        let fall = |across: DVec3, other: DVec3| {
            let step = other.cross(normal);
            (z.dot(step) / across.dot(step) / f64::from(frame.map.side)).abs()
        };
        let slope = 2.5 * (fall(u, v) + fall(v, u));
        let lifted = bare - depth(manual(0.0, 2.5)).0;
        assert!((lifted / slope - 1.0).abs() < 1e-3, "{filter:?}: {lifted}, expected {slope}");
        let constant = 0.25 * z.length();
        let lifted = bare - depth(manual(0.25, 0.0)).0;
        assert!((lifted / constant - 1.0).abs() < 1e-3, "{filter:?}: {lifted}, expected {constant}");
    }
}
