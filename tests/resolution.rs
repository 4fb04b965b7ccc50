//! How much of the error of a map is its resolution.
mod common;
use std::path::{Path, PathBuf};
use std::time::Instant;

use antumbra::lab::bvh::Bvh;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::cpu;
use antumbra::lab::metrics::{Edges, Scores, mask_from_bytes, near_edges};
use antumbra::lab::oracle::{AROUND, Compare, Oracle};
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::TruthCache;
use antumbra::{ShadowTechnique, techniques};

fn shared_cases() -> Vec<PathBuf> {
    let scenes = std::env::var("ANTUMBRA_SCENES").unwrap();
    let folder = Path::new(&scenes).join("../cases");
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn probe() {
    for path in shared_cases() {
        let assignment = Assignment::of_case(&path).expect("a legal case");
        let case = assignment.cases[0].clone();
        let subject = &assignment.subject;
        let (truth, _) = TruthCache::default().get(&case, &subject.model, &|| {});
        let setting = Setting::of(&case);
        let t = Instant::now();
        let bvh = Bvh::new(&subject.model);
        let oracle = Oracle::new(&case, &truth, &bvh).unwrap();
        let t_bvh = t.elapsed();
        let visible = cpu::Visible::draw(&subject.model, &setting.camera, setting.origin);
        let frame = techniques::fsm().fit(&setting.input(subject, 2048)).unwrap();
        let t = Instant::now();
        let image = cpu::render(subject, &visible, &frame, setting.origin);
        let t_cpu = t.elapsed();
        let t = Instant::now();
        let ideal = oracle.mask(&frame, setting.origin, Compare::Plane);
        let t_oracle = t.elapsed();
        let surf = oracle.mask(&frame, setting.origin, Compare::Surface);
        let mask = mask_from_bytes(&image.mask);
        let (ours, best) = (Scores::new(&mask, &truth).unwrap(), Scores::new(&ideal, &truth).unwrap());
        let near = near_edges(&truth, Edges::Centre);
        println!("{} times bvh {t_bvh:?} cpu {t_cpu:?} oracle {t_oracle:?} texel {:?} radius {}", case.name, frame.views[0].texel.world, bvh.radius());
        let p = |n: &str, s: &Scores| println!("   {n}: wrong {:.3}% wide leak {:.1e} false {:.1e} strict leak {:.1e} false {:.1e}", 100.0*s.wrong_center, s.leak_interior, s.false_interior, s.leak_interior_strict, s.false_interior_strict);
        p("ours", &ours); p("plane ", &best); p("surf  ", &Scores::new(&surf, &truth).unwrap());
        let mut hist = [[0u32; 26]; 2];
        let mut hist_s = [[0u32; 26]; 2];
        let mut surf_agrees = [0u32; 2];
        let mut oracle_agrees = [0u32; 2];
        for i in 0..mask.len() {
            if !truth.valid[i] || near[i] || (mask[i] - truth.centre[i]).abs() <= 0.5 { continue; }
            let leak = usize::from(mask[i] > 0.5);
            hist[leak][oracle.lit_around(&frame, setting.origin, i, Compare::Plane).unwrap() as usize] += 1;
            hist_s[leak][oracle.lit_around(&frame, setting.origin, i, Compare::Surface).unwrap() as usize] += 1;
            surf_agrees[leak] += u32::from((surf[i] - truth.centre[i]).abs() > 0.5);
            oracle_agrees[leak] += u32::from((ideal[i] - truth.centre[i]).abs() > 0.5);
        }
        println!("   valid {} false by lit count {:?} oracle agrees {}", ours.valid_pixels, hist[0], oracle_agrees[0]);
        println!("   leak by lit count {:?} oracle agrees {}", hist[1], oracle_agrees[1]);
        println!("   SURF false {:?} agrees {}", hist_s[0], surf_agrees[0]);
        println!("   SURF leak {:?} agrees {}", hist_s[1], surf_agrees[1]);
        println!("   genuine acne {:.1e} leak {:.1e}", f64::from(hist[0][AROUND as usize]) / ours.valid_pixels as f64, f64::from(hist[1][0]) / ours.valid_pixels as f64);
    }
}
