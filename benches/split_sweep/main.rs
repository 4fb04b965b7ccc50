//! What splits buy: wrong pixels of parallel splits over λ, and of this crate's cascades, with and without knowledge of what is
//! seen. `cargo bench --bench split_sweep`, or `-- NAME` for cases whose name contains that; writes `target/split_sweep/sweep.csv`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use antumbra::lab::comparison::Assignment;
use antumbra::lab::experiment::{Backend, BackendChoice, Studio};
use antumbra::lab::subject::{Knowledge, Setting};
use antumbra::lab::truth::TruthCache;
use antumbra::{DepthSplits, Remix, Scheme, Select, Split, Warp};

/// Sides of each map, texels.
const SIZES: [u32; 2] = [512, 1024];

/// Maps of every technique.
const MAPS: u8 = 4;

fn split(scheme: Scheme, select: Select, warp: Warp) -> Remix {
    Remix {
        split: Split::Depth(DepthSplits { maps: MAPS, scheme, select, ..DepthSplits::DEFAULT }),
        warp,
        ..Remix::default()
    }
}

/// By name, with what they are told.
fn techniques() -> Vec<(String, Remix, Knowledge)> {
    let practical = |lambda| Scheme::Practical { lambda, offset: 0.0 };
    let mut all = vec![];
    for lambda in [0.5, 0.3, 0.65, 0.8, 1.0] {
        let mut remix = split(practical(lambda), Select::Depth, Warp::Focused);
        if let Split::Depth(splits) = &mut remix.split {
            splits.enough = 0.0;
        }
        all.push((format!("pssm {lambda}"), remix, Knowledge::Bounds));
    }
    for (name, knowledge) in [("", Knowledge::Bounds), (" points", Knowledge::Points), (" depths", Knowledge::Depths)] {
        all.push((format!("pssm .5 finest{name}"), split(practical(0.5), Select::Finest, Warp::Focused), knowledge));
        all.push((
            format!("pssm .8 finest warped{name}"),
            split(practical(0.8), Select::Finest, Warp::LeastError),
            knowledge,
        ));
        all.push((format!("equal depth{name}"), split(Scheme::EqualError, Select::Depth, Warp::Focused), knowledge));
        all.push((format!("equal finest{name}"), split(Scheme::EqualError, Select::Finest, Warp::Focused), knowledge));
        all.push((
            format!("equal finest warped{name}"),
            split(Scheme::EqualError, Select::Finest, Warp::LeastError),
            knowledge,
        ));
    }
    all
}

fn assignments(only: Option<&str>) -> Result<Vec<(&'static str, Assignment)>, String> {
    let mut assignments = Vec::new();
    if let Ok(scenes) = std::env::var("ANTUMBRA_SCENES") {
        let folder = Path::new(&scenes).join("../cases");
        let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut paths: Vec<PathBuf> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
        paths.sort();
        for path in paths.iter().filter(|path| path.extension().is_some_and(|found| found == "json")) {
            assignments.push(("shared", Assignment::of_case(path)?));
        }
    }
    for scene in ["treeline", "sparse-city"] {
        assignments.push(("built-in", Assignment::of_scene(scene)?));
    }
    for (_, assignment) in &mut assignments {
        let scene = assignment.scene.clone();
        assignment.cases.retain(|case| only.is_none_or(|only| format!("{scene}/{}", case.name).contains(only)));
    }
    Ok(assignments)
}

fn main() -> Result<(), String> {
    let only = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let (mut backend, why) = Backend::open(BackendChoice::Cpu)?;
    if let Some(why) = why {
        println!("{why}");
    }
    let mut text = "set,scene,case,size,technique,views,predicted,wrong\n".to_owned();
    for (set, assignment) in assignments(only.as_deref())? {
        for case in &assignment.cases {
            let (truth, _) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
            for knowledge in [Knowledge::Bounds, Knowledge::Points, Knowledge::Depths] {
                let studio = Studio::new(&mut backend, &assignment.subject, Setting::of(case))
                    .map_err(|error| error.to_string())?;
                let mut studio = studio.knowing(knowledge);
                for (name, remix, _) in techniques().into_iter().filter(|(_, _, known)| *known == knowledge) {
                    for side in SIZES {
                        let shot = studio.shoot(&remix, side, 1).map_err(|error| error.to_string())?;
                        let scores = shot.scores(&truth).map_err(|error| error.to_string())?;
                        let views = shot.frame.views.len();
                        let predicted = shot.frame.predicted.error;
                        let wrong = scores.wrong_center;
                        println!(
                            "{set} {} {} {side} {name}: {views} maps, {:.3} %",
                            assignment.scene,
                            case.name,
                            100.0 * wrong
                        );
                        let _ = writeln!(
                            text,
                            "{set},{},{},{side},{name},{views},{predicted},{wrong}",
                            assignment.scene, case.name
                        );
                    }
                }
            }
        }
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../split_sweep");
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    std::fs::write(folder.join("sweep.csv"), text).map_err(|error| error.to_string())
}
