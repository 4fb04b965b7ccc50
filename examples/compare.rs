//! The main job: every technique on your scene and camera, measured against ray-traced truth, as a report to look at.
//!
//! ```sh
//! cargo run --release --example compare                      # TreeLine and SparseCity, all techniques
//! cargo run --release --example compare -- --scene town.glb --size 1024,2048
//! ```

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use antumbra::lab::case::Case;
use antumbra::lab::cli::{self, BackendName};
use antumbra::lab::comparison::{Assignment, Programme, photograph};
use antumbra::lab::experiment::Backend;
use antumbra::lab::report::{INDEX_FILE, RESULTS_FILE, Report, write_report};
use antumbra::lab::truth::TruthCache;
use antumbra::techniques;
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

/// Measures shadow-mapping techniques on scenes and cameras against ray-traced truth, and writes a report.
///
/// With no arguments: the built-in scenes TreeLine and SparseCity, all their viewpoints, all techniques, maps of 512,
/// 1024 and 2048 texels, into target/compare. Each run gives a picture of the shadows, a map of its errors, and a row
/// of figures: errors against the truth, times of fit, casters, filter and receivers, memory, and what was left out.
///
/// Truth (traced once and kept under target/antumbra-truth): visibility of the light at each pixel's centre, and
/// averaged over its area. A perfect hard-edged shadow scores 0 against the first and the "floor" against the second.
#[derive(Parser)]
#[command(version, after_help = AFTER_HELP)]
struct Arguments {
    /// A scene: treeline, sparse-city, or a .glb or .gltf file (y up), looked at from around. Repeatable.
    #[arg(long, value_name = "treeline|sparse-city|FILE.glb")]
    scene: Vec<String>,
    /// A case file: one camera and light over one scene (see `mask --help` for its fields). Repeatable.
    #[arg(long, value_name = "FILE.json")]
    case: Vec<PathBuf>,
    /// Techniques, separated by commas, or all. ssm: one map over the scene; fsm: one map over what is in view.
    #[arg(long, value_name = "LIST|all", default_value = "all")]
    technique: String,
    /// Sides of maps in texels, separated by commas, each 1 to 16384.
    #[arg(long, value_name = "LIST", default_value = "512,1024,2048")]
    size: String,
    /// Renderer: auto takes the GPU where there is one, else the software renderer.
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    backend: BackendName,
    /// A look in under two minutes: three viewpoints a scene, half-size pictures, maps of 512 and 1024.
    #[arg(long)]
    quick: bool,
    /// Folder of the report.
    #[arg(long, value_name = "DIR", default_value = "target/compare")]
    out: PathBuf,
}

const AFTER_HELP: &str = "Examples:
  compare --quick
  compare --scene town.glb --size 1024,2048 --out town-report
  compare --case street.json --technique fsm --backend cpu
Open index.html of the report folder in a browser. Bad input ends with one line and exit code 2, and writes nothing.";

/// Viewpoints of a scene in a quick run.
const QUICK_VIEWPOINTS: usize = 3;
/// Times each pass is drawn: medians of software drivers settle from about five on; a quick run is content with three.
const REPETITIONS: [u32; 2] = [5, 3];

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => cli::fail(&problem),
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let start = Instant::now();
    // Check everything before anything is drawn.
    let mut programme = programme(arguments)?;
    let assignments = assignments(arguments)?;
    cli::writable_folder(&arguments.out)?;
    let (mut backend, why_not) = Backend::open(arguments.backend.into())?;
    programme.techniques.iter_mut().for_each(|(_, remix)| *remix = backend.adapted(remix));
    let mut report = Report {
        title: "Shadow techniques compared".to_owned(),
        command: command_line(),
        commit: cli::commit(),
        adapter: backend.adapter(),
        started: cli::now(),
        heat_legend: "Red: light where there is none. Blue: shadow where there is none. Dim picture: the truth."
            .to_owned(),
        ..Report::default()
    };
    println!("Renderer: {} ({})", backend.name(), backend.adapter());
    if let Some(why) = why_not {
        println!("{why}");
        report.notes.push(format!("Drawn by the software renderer: {why}"));
    }
    // Photograph case by case.
    let cache = TruthCache::default();
    for assignment in &assignments {
        for case in &assignment.cases {
            let rows = bar(u64::from(case.viewport[1]), &format!("{}: tracing the truth", case.name));
            let (truth, _) = cache.get(case, &assignment.subject.model, &|| rows.inc(1));
            rows.finish_and_clear();
            let runs =
                bar((programme.techniques.len() * programme.sizes.len()) as u64, &format!("{}: drawing", case.name));
            let section = photograph(&mut backend, assignment, case, &truth, &programme, &mut |row| {
                runs.inc(1);
                runs.suspend(|| print_row(row));
            })?;
            runs.finish_and_clear();
            report.scenes.push(section);
        }
    }
    // Write.
    report.duration = start.elapsed();
    write_report(&arguments.out, &report).map_err(|error| error.to_string())?;
    let folder = arguments.out.display();
    println!(
        "{folder}/{INDEX_FILE} and {folder}/{RESULTS_FILE}: {} runs in {:.0?}",
        report.rows().count(),
        report.duration
    );
    Ok(())
}

fn programme(arguments: &Arguments) -> Result<Programme, String> {
    let techniques = if arguments.technique == "all" {
        techniques::NAMED.iter().map(|(name, technique)| ((*name).to_owned(), technique())).collect()
    } else {
        let names = arguments.technique.split(',').map(str::trim);
        names.map(|name| cli::technique(name).map(|remix| (name.to_owned(), remix))).collect::<Result<_, _>>()?
    };
    let mut sizes = arguments.size.split(',').map(cli::map_size).collect::<Result<Vec<u32>, _>>()?;
    if arguments.quick {
        sizes.truncate(2);
    }
    Ok(Programme { techniques, sizes, repetitions: REPETITIONS[usize::from(arguments.quick)] })
}

fn assignments(arguments: &Arguments) -> Result<Vec<Assignment>, String> {
    let built_in = ["treeline".to_owned(), "sparse-city".to_owned()];
    let scenes = match (arguments.scene.is_empty(), arguments.case.is_empty()) {
        (true, true) => &built_in[..],
        _ => &arguments.scene[..],
    };
    let mut assignments: Vec<Assignment> =
        scenes.iter().map(|scene| Assignment::of_scene(scene)).collect::<Result<_, _>>()?;
    for path in &arguments.case {
        assignments.push(Assignment::of_case(path)?);
    }
    if arguments.quick {
        assignments.iter_mut().for_each(shorten);
    }
    Ok(assignments)
}

/// Fewer viewpoints and smaller pictures.
fn shorten(assignment: &mut Assignment) {
    assignment.cases.truncate(QUICK_VIEWPOINTS);
    let halve = |case: &mut Case| case.viewport = case.viewport.map(|side| side.div_ceil(2));
    assignment.cases.iter_mut().for_each(halve);
}

fn print_row(row: &antumbra::lab::report::Row) {
    if row.failed() {
        println!("  {} {} {:>5}: {}", row.case, row.technique, row.size, row.left_out.join("; "));
        return;
    }
    println!(
        "  {} {} {:>5}: {:.2} % wrong, mae {:.4} (floor {:.4}), leak {:.1e}, acne {:.1e}, {:.1} ms",
        row.case,
        row.technique,
        row.size,
        100.0 * row.wrong_center,
        row.mae,
        row.floor_mae,
        row.leak_interior,
        row.false_interior,
        row.total_ms
    );
}

/// A progress bar that shows on terminals only.
fn bar(length: u64, message: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(length).with_style(style).with_message(message.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// The command that repeats this run.
fn command_line() -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let separator = if arguments.is_empty() { "" } else { " -- " };
    format!("cargo run --release --example compare{separator}{}", arguments.join(" "))
}
