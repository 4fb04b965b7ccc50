//! SparseCity after 1, 4 and 16 iterations: `target/eye-blur-*.png`, to be looked at.

use antumbra::ShadowTechnique;
use antumbra::encoding::eye_blur::EyeBlur;
use antumbra::lab::cpu::{Visible, render};
use antumbra::lab::eye_blur::blur;
use antumbra::lab::metrics::{Scores, mask_from_bytes};
use antumbra::lab::sparse_city::sparse_city;
use antumbra::lab::subject::{Setting, Subject, case_of};
use antumbra::lab::truth::Truth;
use antumbra::lab::viewpoints::sparse_city_viewpoints;
use antumbra::techniques;
use glam::UVec2;

use crate::{NEAR, reversed};

/// Pixels of the picture, and texels of the map.
const PICTURE: [u32; 2] = [480, 360];
const SIDE: u32 = 1024;

#[test]
fn iterations_trade_detail_for_even_shadow() {
    let subject = Subject::new(sparse_city());
    let viewpoint = sparse_city_viewpoints().swap_remove(0);
    let mut case = case_of(&viewpoint, "sparse-city");
    case.viewport = PICTURE;
    let (setting, size) = (Setting::of(&case), UVec2::from(PICTURE));
    let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
    let technique = techniques::fsm();
    let frame = technique.fit(&setting.input(&subject, &[], technique.wgsl_key(), SIDE)).expect("a legal input");
    let mask = mask_from_bytes(&render(&subject, &visible, &frame, &setting).mask);
    let truth = Truth::trace(&case, &subject.model, &|| {});
    // The depth buffer of a reversed projection.
    let depth: Vec<f32> = truth.depth.iter().map(|depth| (NEAR / f64::from(*depth)) as f32).collect();
    let clip_from_view = reversed(viewpoint.fov_y, f64::from(size.x) / f64::from(size.y));
    let mut scores = Vec::new();
    println!("| iterations | mean error | wrong by more than a half |\n|--:|--:|--:|");
    for iterations in [0, 1, 4, 16] {
        let settings = EyeBlur { radius: 1.0, iterations: iterations.max(1), ..EyeBlur::default() };
        let uniforms = settings.uniforms(&clip_from_view, size).expect("legal settings");
        let shown = blur(&uniforms, iterations, size, &mask, &depth);
        let found = Scores::new(&shown, &truth).expect("a mask of the truth's size");
        println!("| {iterations} | {:.2} % | {:.2} % |", 100.0 * found.mae, 100.0 * found.wrong);
        scores.push(found.mae);
        let bytes: Vec<u8> = shown.iter().map(|value| (value * 255.0).round() as u8).collect();
        let path = format!("{}/target/eye-blur-{iterations}.png", env!("CARGO_MANIFEST_DIR"));
        let picture = image::GrayImage::from_raw(size.x, size.y, bytes).expect("a byte for each pixel");
        picture.save(path).expect("a writable picture");
        // What lies beyond edges of depth stays out: sky stays lit.
        let sky = (0..shown.len()).filter(|&index| truth.depth[index].is_infinite());
        assert!(sky.map(|index| 1.0 - shown[index]).all(|dark| dark.abs() < 1e-6));
    }
    // The more it is blurred, the more it differs from the truth: this hides artefacts, and finds nothing out.
    assert!(scores[3] > scores[1], "{scores:?}");
}
