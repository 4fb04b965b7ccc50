//! What splits buy: wrong pixels of parallel splits over λ, of this crate's cascades, with and without knowledge of
//! what is seen, and of maps that share their texels. `cargo bench --bench split_sweep` writes `docs/SPLITS.md` and
//! `target/split_sweep/sweep.csv`; with `-- NAME`, cases whose name contains that alone, and no page.

mod page;

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use antumbra::lab::cli;
use antumbra::lab::comparison::Assignment;
use antumbra::lab::experiment::{Backend, BackendChoice, Shot, Studio};
use antumbra::lab::files::write_whole;
use antumbra::lab::subject::{Knowledge, Setting};
use antumbra::lab::truth::{Truth, TruthCache};
use antumbra::{DepthSplits, MAX_VIEWS, Remix, Scheme, Select, Share, Split, Warp, techniques};

/// Sides of each map, texels.
const SIZES: [u32; 2] = [512, 1024];

/// Maps of every technique.
const MAPS: u8 = 4;

/// λ of the parallel splits; the first one is the yardstick.
const LAMBDAS: [f32; 5] = [0.5, 0.3, 0.65, 0.8, 1.0];

/// One picture.
#[derive(Clone, Debug)]
struct Record {
    set: &'static str,
    case: String,
    size: u32,
    technique: String,
    views: usize,
    texels: u64,
    layers: u32,
    wrong: f64,
}

impl Record {
    /// What a picture is worth.
    fn of(
        shot: &Shot,
        truth: &Truth,
        set: &'static str,
        case: &str,
        size: u32,
        technique: String,
    ) -> Result<Self, String> {
        let wrong = shot.scores(truth).map_err(|error| error.to_string())?.wrong_center;
        let (case, views, texels) = (case.to_owned(), shot.frame.views.len(), shot.texels());
        let layers = shot.frame.views.iter().map(|view| view.layer + 1).max().unwrap_or(0);
        println!("{case} {size} {technique}: {views} maps, {:.3} %", 100.0 * wrong);
        Ok(Self { set, case, size, technique, views, texels, layers, wrong })
    }
}

/// By name.
fn splits() -> Vec<(String, Remix)> {
    let split = |scheme, select, warp, enough| Remix {
        split: Split::Depth(DepthSplits { maps: MAPS, scheme, select, enough, ..DepthSplits::DEFAULT }),
        warp,
        ..Remix::default()
    };
    let practical = |lambda| Scheme::Practical { lambda, offset: 0.0 };
    let enough = DepthSplits::DEFAULT.enough;
    let plain = LAMBDAS
        .map(|lambda| (format!("λ {lambda}, by depth"), split(practical(lambda), Select::Depth, Warp::Focused, 0.0)));
    let ours = [
        ("λ 0.5, finest", split(practical(0.5), Select::Finest, Warp::Focused, 0.0)),
        ("λ 0.8, finest, least-error", split(practical(0.8), Select::Finest, Warp::LeastError, 0.0)),
        ("equal error, by depth", split(Scheme::EqualError, Select::Depth, Warp::Focused, enough)),
        ("equal error, finest", split(Scheme::EqualError, Select::Finest, Warp::Focused, enough)),
        ("cascades", split(Scheme::EqualError, Select::Finest, Warp::LeastError, enough)),
    ];
    plain.into_iter().chain(ours.map(|(name, remix)| (name.to_owned(), remix))).collect()
}

/// Ways to share texels, by name and number of layers; the first one is the yardstick.
fn shares() -> Vec<(String, u32, Remix)> {
    let maps_of = |maps, share| {
        let splits = DepthSplits { maps, ..DepthSplits::DEFAULT };
        Remix { split: Split::Depth(splits), share, ..techniques::cascades() }
    };
    let published = |share| {
        let scheme = Scheme::Practical { lambda: LAMBDAS[0], offset: 0.0 };
        let splits = DepthSplits { maps: MAPS, scheme, select: Select::Depth, enough: 0.0, ..DepthSplits::DEFAULT };
        Remix { split: Split::Depth(splits), share, ..techniques::pssm() }
    };
    let (layers, most) = (u32::from(MAPS), MAX_VIEWS as u8);
    let named = |name: &str, layers: u32, remix: Remix| (name.to_owned(), layers, remix);
    let mut shares = vec![
        named(page::EQUAL, layers, maps_of(MAPS, Share::Equal)),
        named("4 maps, equal error", layers, maps_of(MAPS, Share::EqualError)),
        named("4 maps, equal, λ 0.5, by depth", layers, published(Share::Equal)),
        named("4 maps, equal error, λ 0.5, by depth", layers, published(Share::EqualError)),
    ];
    for maps in MAPS + 1..=most {
        shares.push((format!("{maps} maps, least error"), layers, maps_of(maps, Share::LeastError)));
    }
    for (layers, fewer) in [(2, "2 maps, equal, in 2 layers"), (1, "1 map, in 1 layer")] {
        shares.push(named(fewer, layers, maps_of(layers as u8, Share::Equal)));
        for maps in [MAPS, most] {
            let name = format!("{maps} maps, least error, in {layers} layer{}", if layers > 1 { "s" } else { "" });
            shares.push((name, layers, maps_of(maps, Share::LeastError)));
        }
    }
    shares.push(named("8 maps, equal, in 8 layers", 8, maps_of(most, Share::Equal)));
    shares
}

fn assignments(only: Option<&str>) -> Result<Vec<(&'static str, Assignment)>, String> {
    let mut assignments: Vec<_> = Assignment::shared()?.into_iter().map(|of| ("shared", of)).collect();
    for scene in ["treeline", "sparse-city"] {
        assignments.push(("built-in", Assignment::of_scene(scene)?));
    }
    for (_, assignment) in &mut assignments {
        let scene = assignment.scene.clone();
        assignment.cases.retain(|case| only.is_none_or(|only| format!("{scene}/{}", case.name).contains(only)));
    }
    Ok(assignments)
}

/// Photographs a case with every way to share texels.
fn sweep_shares(
    studio: Studio,
    set: &'static str,
    case: &str,
    truth: &Truth,
    suffix: &str,
    records: &mut Vec<Record>,
) -> Result<(), String> {
    let mut studio = studio;
    for (name, layers, remix) in shares() {
        studio = studio.with_layers(layers);
        for size in SIZES {
            let shot = studio.shoot(&remix, size, 1).map_err(|error| error.to_string())?;
            records.push(Record::of(&shot, truth, set, case, size, format!("{name}{suffix}"))?);
        }
    }
    Ok(())
}

/// Photographs every case with every technique, told as much as `knowledge` says.
fn sweep(
    backend: &mut Backend,
    set: &'static str,
    assignment: &Assignment,
    records: &mut Vec<Record>,
    shared: &mut Vec<Record>,
) -> Result<(), String> {
    for case in &assignment.cases {
        let called = if set == "shared" { case.name.clone() } else { format!("{}/{}", assignment.scene, case.name) };
        let (truth, _) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
        for (suffix, knowledge) in page::KNOWN {
            let studio =
                Studio::new(backend, &assignment.subject, Setting::of(case)).map_err(|error| error.to_string())?;
            let mut studio = studio.knowing(knowledge);
            for (name, remix) in splits() {
                // The yardstick and its kin know bounds alone.
                if knowledge != Knowledge::Bounds && name.ends_with("by depth") && name.starts_with('λ') {
                    continue;
                }
                for size in SIZES {
                    let shot = studio.shoot(&remix, size, 1).map_err(|error| error.to_string())?;
                    records.push(Record::of(&shot, &truth, set, &called, size, format!("{name}{suffix}"))?);
                }
            }
            if knowledge != Knowledge::Depths {
                sweep_shares(studio, set, &called, &truth, suffix, shared)?;
            }
        }
    }
    Ok(())
}

fn main() {
    cli::bench(run);
}

fn run() -> Result<(), String> {
    let start = Instant::now();
    let only = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let (mut backend, _) = Backend::open(BackendChoice::Cpu)?;
    let (mut records, mut shared) = (Vec::new(), Vec::new());
    for (set, assignment) in assignments(only.as_deref())? {
        sweep(&mut backend, set, &assignment, &mut records, &mut shared)?;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut text = "set,case,size,technique,views,texels,layers,wrong\n".to_owned();
    for Record { set, case, size, technique, views, texels, layers, wrong } in records.iter().chain(&shared) {
        let _ = writeln!(text, "{set},{case},{size},\"{technique}\",{views},{texels},{layers},{wrong}");
    }
    let folder = root.join("target/split_sweep");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    write_whole(&folder.join("sweep.csv"), text.as_bytes())?;
    if only.is_some() {
        return Ok(());
    }
    let meta = cli::provenance("split_sweep", &[], backend.adapter(), start);
    write_whole(&root.join("docs/SPLITS.md"), page::page(&meta, &records, &shared).as_bytes())
}
