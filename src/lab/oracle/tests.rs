//! Ideal lookups: frames placed elsewhere, and texels from coarse to fine.

use super::*;
use crate::encoding::stage::Encoding;
use crate::lab::case::CaseCamera;
use crate::lab::metrics::Scores;
use crate::lab::scene::SceneModel;
use crate::lab::subject::Subject;
use crate::remix::Remix;
use crate::technique::ShadowTechnique;
use crate::techniques;

impl Compare {
    const ALL: [Self; 3] = [Self::Plane, Self::Nearer, Self::Surface];
}

/// A sheet: a corner and two sides.
type Sheet = [DVec3; 3];

const GROUND: Sheet = [DVec3::new(-8.0, 0.0, -8.0), DVec3::new(0.0, 0.0, 16.0), DVec3::new(16.0, 0.0, 0.0)];

fn scene(sheets: &[Sheet]) -> Subject {
    let mut model = SceneModel { name: "sheets".into(), ..SceneModel::default() };
    for &[corner, side, other] in sheets {
        let first = model.positions.len() as u32;
        model.positions.extend([corner, corner + side, corner + side + other, corner + other]);
        model.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        model.objects.push(model.triangles.len() - 2..model.triangles.len());
    }
    Subject::new(model)
}

fn case(travel: DVec3) -> Case {
    let (eye, target) = (DVec3::new(3.0, 7.0, 11.0), DVec3::new(0.0, 0.5, 0.0));
    Case {
        name: "sheets".into(),
        scene: "sheets".into(),
        camera: CaseCamera { eye, target, up: DVec3::Y, fov_y_deg: 50.0, near: 0.1, far: 60.0 },
        light: CaseLight::Directional { travel: travel.normalize() },
        viewport: [96, 64],
        shadow_distance: 60.0,
        folder: std::path::PathBuf::new(),
    }
}

fn fit(remix: &Remix, setting: &Setting, subject: &Subject, side: u32) -> ShadowFrame {
    remix.fit(&setting.input(subject, &[], remix.wgsl_key(), side)).unwrap()
}

/// Scores of an ideal lookup.
fn scores(subject: &Subject, case: &Case, filter: Pcf, side: u32, compare: Compare) -> Scores {
    let truth = Truth::trace(case, &subject.model, &|| {});
    let bvh = Bvh::new(&subject.model);
    let setting = Setting::of(case);
    let remix = Remix { encoding: Encoding::Depth(filter), ..techniques::fsm() };
    let frame = fit(&remix, &setting, subject, side);
    let mask = Oracle::new(case, &truth, &bvh).unwrap().mask(&frame, setting.origin, compare);
    Scores::new(&mask, &truth).unwrap()
}

#[test]
fn a_plane_never_shadows_itself() {
    let subject = scene(&[GROUND]);
    for down in [1.0, 0.1, 1e-2, 1e-3] {
        let case = case(DVec3::new(0.7, -down, 0.4));
        for filter in Pcf::ALL {
            for compare in Compare::ALL {
                let scores = scores(&subject, &case, filter, 64, compare);
                assert!(scores.valid_pixels > 1000);
                assert_eq!(scores.mae, 0.0, "{filter:?} {compare:?}, light falls by {down}");
            }
        }
    }
}

#[test]
fn fine_texels_show_the_truth_and_coarse_ones_do_not() {
    let roof = [DVec3::new(-2.0, 1.5, -2.0), DVec3::new(0.0, 0.0, 4.0), DVec3::new(4.0, 0.0, 0.0)];
    let (subject, case) = (scene(&[GROUND, roof]), case(DVec3::new(0.4, -1.0, 0.3)));
    for compare in Compare::ALL {
        let [coarse, fine] =
            [64, 4096].map(|side| scores(&subject, &case, Pcf::Hardware2x2, side, compare).wrong_center);
        assert!(fine < 1e-3 && coarse > 5.0 * fine, "{compare:?}: {coarse} and {fine} wrong");
    }
}

/// Where a wall stands on the ground, its plane runs on below, into the ground's shadow, where the wall does not.
#[test]
fn only_the_bare_plane_runs_on_below_the_ground() {
    let wall = [DVec3::new(-4.0, 0.0, -3.0), DVec3::new(8.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 0.0)];
    let (subject, case) = (scene(&[GROUND, wall]), case(DVec3::new(0.3, -1.0, -0.2)));
    let truth = Truth::trace(&case, &subject.model, &|| {});
    let bvh = Bvh::new(&subject.model);
    let setting = Setting::of(&case);
    let frame = fit(&techniques::fsm(), &setting, &subject, 64);
    let oracle = Oracle::new(&case, &truth, &bvh).unwrap();
    let on_wall: Vec<usize> =
        (0..truth.valid.len()).filter(|&pixel| truth.valid[pixel] && truth.triangle[pixel] >= 2).collect();
    assert!(on_wall.len() > 100, "{}", on_wall.len());
    assert!(on_wall.iter().all(|&pixel| truth.centre[pixel] == 1.0));
    let dark = Compare::ALL.map(|compare| {
        let mask = oracle.mask(&frame, setting.origin, compare);
        on_wall.iter().filter(|&&pixel| mask[pixel] < 0.5).count()
    });
    let [plane, nearer, surface] = dark;
    assert!(plane > 10 && 4 * nearer < plane && surface == 0, "{dark:?}");
    // What surrounds the wall is lit; what surrounds its plane is not.
    let least = |compare| on_wall.iter().filter_map(|&p| oracle.lit_around(&frame, setting.origin, p, compare)).min();
    assert!(least(Compare::Plane) < Some(AROUND));
    assert_eq!(least(Compare::Surface), Some(AROUND));
}

#[test]
fn a_frame_placed_elsewhere_draws_and_reads_the_same_texels() {
    let (subject, case) = (scene(&[GROUND]), case(DVec3::new(0.4, -1.0, 0.3)));
    let setting = Setting::of(&case);
    let fitted = fit(&techniques::fsm(), &setting, &subject, 256);
    let by = DVec2::new(0.25, -0.5);
    let moved = placed_elsewhere(&fitted, by);
    let at = glam::Vec3::new(-1.0, -6.5, -12.0);
    let read = |frame: &ShadowFrame| {
        let uniforms = &frame.uniforms.views[0];
        let [u, v] =
            [uniforms.u_from_render, uniforms.v_from_render].map(|row| Vec4::from_array(row).dot(at.extend(1.0)));
        DVec2::new(f64::from(u), f64::from(v)) * f64::from(frame.map.side)
    };
    let drawn = |frame: &ShadowFrame| {
        let (view, clip) = (&frame.views[0], frame.views[0].clip_from_render * at.extend(1.0));
        let unit = DVec2::new(0.5 + 0.5 * f64::from(clip.x), 0.5 - 0.5 * f64::from(clip.y));
        let viewport = view.viewport.as_dvec4();
        DVec2::new(viewport.x, viewport.y) + unit * DVec2::new(viewport.z, viewport.w)
    };
    assert!((read(&moved) - read(&fitted) + by).length() < 1e-3);
    assert!((drawn(&moved) - read(&moved)).length() < 1e-3);
}
