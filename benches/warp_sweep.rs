//! How strong a warp pays: true error over κλ, on many scenes and viewpoints, map sizes 256 to 2048.
//!
//! `cargo bench --bench warp_sweep` sweeps the built-in scenes and, where `ANTUMBRA_SCENES` names a folder, a tour of every scene in it and
//! the cases beside it. Every picture is kept as a line of `target/warp_sweep/sweep.csv`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use antumbra::lab::comparison::Assignment;
use antumbra::lab::experiment::{Backend, BackendChoice, Studio};
use antumbra::lab::files::write_whole;
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::TruthCache;
use antumbra::{Remix, Warp, techniques};

/// Sides of maps, texels.
const SIZES: [u32; 4] = [256, 512, 1024, 2048];
/// κλ: from none to more than any picture has wanted.
const STRENGTHS: [f32; 16] = [0.0, 0.15, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 30.0, 45.0, 60.0];

/// Techniques beside the sweep, and whether the guard is on.
const NAMED: [(&str, bool); 10] = [
    ("fsm", true),
    ("psm", false),
    ("psm", true),
    ("tsm", false),
    ("tsm", true),
    ("lispsm", false),
    ("lispsm", true),
    ("minimax", false),
    ("minimax", true),
    ("least-error", true),
];

fn main() {
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    if let Err(problem) = run() {
        eprintln!("error: {problem}");
        std::process::exit(2);
    }
}

fn glob(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut found: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .collect();
    found.sort();
    Ok(found)
}

fn run() -> Result<(), String> {
    let (mut backend, why_not) = Backend::open(BackendChoice::Auto)?;
    if let Some(why) = why_not {
        println!("{why}");
    }
    let only = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let mut assignments = Vec::new();
    if let Ok(scenes) = std::env::var("ANTUMBRA_SCENES") {
        let scenes = Path::new(&scenes);
        for path in glob(&scenes.join("../cases"), "json")? {
            assignments.push(("shared", Assignment::of_case(&path)?));
        }
        for path in glob(scenes, "glb")? {
            let name = path.display().to_string();
            assignments.push(("tour", Assignment::of_scene(&name)?));
        }
    }
    for scene in ["treeline", "sparse-city"] {
        assignments.push(("built-in", Assignment::of_scene(scene)?));
    }
    let mut csv = "set,scene,case,size,strength,applied,wrong,near,mid,far,acne,leak\n".to_owned();
    for (set, assignment) in &assignments {
        for case in &assignment.cases {
            let name = format!("{set}/{}/{}", assignment.scene, case.name);
            if only.as_ref().is_some_and(|only| !name.contains(only.as_str())) {
                continue;
            }
            let (truth, _) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
            let mut studio =
                Studio::new(&mut backend, &assignment.subject, Setting::of(case)).map_err(|error| error.to_string())?;
            for size in SIZES {
                let mut line = format!("{name} {size}:");
                let fixed = STRENGTHS.map(|strength| (strength.to_string(), Warp::Fixed { strength }, true));
                let chosen = NAMED.map(|(name, guard)| {
                    let warp = techniques::by_name(name).map_or(Warp::Focused, |remix| remix.warp);
                    (if guard { name.to_owned() } else { format!("{name} unguarded") }, warp, guard)
                });
                for (strength, warp, guard) in fixed.into_iter().chain(chosen) {
                    let remix = Remix { warp, guard, ..Remix::default() };
                    let shot = studio.shoot(&remix, size, 1).map_err(|error| error.to_string())?;
                    let scores = shot.scores(&truth).map_err(|error| error.to_string())?;
                    let applied = shot.frame.views.first().map_or(0.0, |view| view.warp_strength);
                    let [near, mid, far] = scores.thirds.map(|third| third.wrong_center);
                    let _ = writeln!(
                        csv,
                        "{set},{},{},{size},{strength},{applied},{},{near},{mid},{far},{},{}",
                        assignment.scene, case.name, scores.wrong_center, scores.false_interior, scores.leak_interior
                    );
                    let _ = write!(line, " {:.3}", 100.0 * scores.wrong_center);
                }
                println!("{line}");
            }
        }
        write_whole(Path::new("target/warp_sweep/sweep.csv"), csv.as_bytes())?;
    }
    Ok(())
}
