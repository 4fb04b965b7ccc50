//! Error against run time, measured against ray-traced truth: each technique, map sizes 256 to 4096,
//! every built-in viewpoint.
//!
//! `cargo bench --bench work_precision` writes `docs/BENCHMARKS.md`, `docs/work_precision.csv` and
//! `docs/work_precision-*.svg`; `-- --quick` looks at one viewpoint a scene at half size,
//! into `target/work_precision` instead.
//!
//! Beside every map size stands what the same passes cost written by hand (a depth pass with one matrix, a receiver
//! with one comparison sample and a constant bias), drawn in turns in the same run; the receiver with three yardsticks.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use antumbra::lab::cli;
use antumbra::lab::comparison::{Assignment, Programme, photograph};
use antumbra::lab::experiment::{Backend, BackendChoice, Studio};
use antumbra::lab::files::write_whole;
use antumbra::lab::gpu::Race;
use antumbra::lab::report::{Axes, Axis, Floor, PlotPoint, Row, Series, error_time_svg, markdown_table, write_csv};
use antumbra::lab::subject::Setting;
use antumbra::lab::truth::TruthCache;
use antumbra::techniques;

/// Sides of maps, texels.
const SIZES: [u32; 5] = [256, 512, 1024, 2048, 4096];
/// Times each pass is drawn for its median.
const REPETITIONS: u32 = 7;
/// Turns of a race: its medians are ratios of neighbours in time.
const TURNS: u32 = 31;
/// A run this wrong drew something else than shadows: it is reported as failed, not timed as if it had worked.
const WORST_WRONG: f64 = 0.25;

fn main() {
    let quick = std::env::args().any(|argument| argument == "--quick");
    // `cargo test --benches` only wants to know that this builds and starts.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    if let Err(problem) = run(quick) {
        eprintln!("error: {problem}");
        std::process::exit(2);
    }
}

/// What one scene's cases gave.
struct Measured {
    scene: String,
    rows: Vec<Row>,
    races: Vec<(String, u32, Race)>,
}

fn run(quick: bool) -> Result<(), String> {
    let start = Instant::now();
    let (mut backend, why_not) = Backend::open(BackendChoice::Auto)?;
    if let Some(why) = why_not {
        println!("{why}");
    }
    println!("{} ({})", backend.adapter(), backend.name());
    let programme = Programme {
        techniques: techniques::NAMED
            .iter()
            .map(|(name, technique)| ((*name).to_owned(), backend.adapted(&technique())))
            .collect(),
        sizes: if quick { SIZES[1..4].to_vec() } else { SIZES.to_vec() },
        repetitions: REPETITIONS,
    };
    let measured: Vec<Measured> = ["treeline", "sparse-city"]
        .into_iter()
        .map(|scene| measure(&mut backend, scene, &programme, quick))
        .collect::<Result<_, _>>()?;
    write(&backend, &measured, quick, start.elapsed())
}

fn measure(backend: &mut Backend, scene: &str, programme: &Programme, quick: bool) -> Result<Measured, String> {
    let mut assignment = Assignment::of_scene(scene)?;
    if quick {
        assignment.cases.truncate(1);
        assignment.cases.iter_mut().for_each(|case| case.viewport = case.viewport.map(|side| side.div_ceil(2)));
    }
    let mut measured = Measured { scene: scene.to_owned(), rows: Vec::new(), races: Vec::new() };
    for case in &assignment.cases {
        let (truth, _) = TruthCache::default().get(case, &assignment.subject.model, &|| {});
        let section = photograph(backend, &assignment, case, &truth, programme, &mut |_| {})?;
        measured.rows.extend(section.rows.into_iter().map(verified));
        let mut studio =
            Studio::new(backend, &assignment.subject, Setting::of(case)).map_err(|error| error.to_string())?;
        for &size in &programme.sizes {
            let race = studio.race(&techniques::fsm(), size, TURNS).map_err(|error| error.to_string())?;
            measured.races.extend(race.map(|race| (case.name.clone(), size, race)));
        }
        println!("{scene} {}: measured", case.name);
    }
    Ok(measured)
}

/// A row whose picture is a picture of shadows; else a failed one that says so.
fn verified(row: Row) -> Row {
    if row.failed() || row.wrong_center < WORST_WRONG {
        return row;
    }
    let left_out = vec![format!("verification: {:.0} % of the pixels are wrong", 100.0 * row.wrong_center)];
    let Row { scene, case, technique, split, warp, encoding, size, backend, adapter, .. } = row;
    Row { scene, case, technique, split, warp, encoding, size, backend, adapter, left_out, ..Row::default() }
}

fn write(backend: &Backend, measured: &[Measured], quick: bool, took: Duration) -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder: PathBuf = if quick { root.join("target/work_precision") } else { root.join("docs") };
    std::fs::create_dir_all(&folder).map_err(|error| format!("cannot make {} ({error})", folder.display()))?;
    let rows: Vec<Row> = measured.iter().flat_map(|scene| scene.rows.iter().cloned()).collect();
    let command =
        if quick { "cargo bench --bench work_precision -- --quick" } else { "cargo bench --bench work_precision" };
    let (commit, adapter, date) = (cli::commit(), backend.adapter(), cli::now());
    let meta = [("command", command), ("commit", &commit), ("adapter", &adapter), ("date", &date)];
    write_csv(&folder.join("work_precision.csv"), &meta, &rows).map_err(|error| error.to_string())?;
    for scene in measured {
        let svg = curves(scene);
        write_whole(&folder.join(format!("work_precision-{}.svg", scene.scene)), svg.as_bytes())?;
    }
    let page = page(measured, &meta, took)?;
    write_whole(&folder.join("BENCHMARKS.md"), page.as_bytes())?;
    println!("{} and beside it the table and the curves; {took:.0?}", folder.join("BENCHMARKS.md").display());
    Ok(())
}

/// Median over a scene's cases of a figure, for one technique and size.
fn median(rows: &[Row], technique: &str, size: u32, figure: impl Fn(&Row) -> f64) -> f64 {
    median_of(rows.iter().filter(|row| row.technique == technique && row.size == size).map(figure).collect())
}

fn median_of(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// One curve per technique: mean absolute error and time of a frame, medians over the viewpoints.
fn curves(measured: &Measured) -> String {
    let names: Vec<&str> = techniques::NAMED.iter().map(|(name, _)| *name).collect();
    let series: Vec<Series> = names
        .iter()
        .enumerate()
        .map(|(style, name)| Series {
            name: (*name).to_owned(),
            style,
            points: SIZES
                .iter()
                .filter(|size| measured.rows.iter().any(|row| row.size == **size))
                .map(|&size| PlotPoint {
                    x: median(&measured.rows, name, size, |row| row.mae),
                    y: median(&measured.rows, name, size, |row| row.total_ms),
                    label: size.to_string(),
                })
                .collect(),
        })
        .collect();
    let floor = median_of(measured.rows.iter().map(|row| row.floor_mae).collect());
    let axes = Axes {
        x: Axis {
            name: "mean absolute error against the area truth".to_owned(),
            floor: Some(Floor { value: floor, label: "floor".to_owned() }),
        },
        y: Axis { name: "time of a frame, ms".to_owned(), floor: None },
    };
    error_time_svg(&format!("{}: error and time, medians over viewpoints", measured.scene), &series, &axes)
}

fn page(measured: &[Measured], meta: &[(&str, &str)], took: Duration) -> Result<String, String> {
    let mut text = String::from("# Error against run time\n\n");
    let _ = writeln!(text, "This page is written by the command below; every number on it comes from that run.\n");
    for (name, value) in meta {
        let _ = writeln!(text, "- {name}: `{value}`");
    }
    let _ = writeln!(text, "- took: {:.0} s\n", took.as_secs_f64());
    let _ = writeln!(text, "## What the library adds to the least that can be done\n");
    text.push_str(&races(measured));
    for scene in measured {
        let _ = writeln!(text, "## {}\n\n![error and time](work_precision-{}.svg)\n", scene.scene, scene.scene);
        let columns = [
            "case",
            "technique",
            "size",
            "fit_ns",
            "casters_ms",
            "receivers_ms",
            "total_ms",
            "mae",
            "floor_mae",
            "wrong_center",
            "leak_interior",
            "false_interior",
        ];
        text.push_str(&markdown_table(&scene.rows, &columns).map_err(|error| error.to_string())?);
        text.push('\n');
    }
    text.push_str(BIAS);
    Ok(text)
}

/// A ratio of a race.
type Ratio = fn(&Race) -> f64;

/// The columns of the table of races: heading, and ratio.
const RATIOS: [(&str, Ratio); 6] = [
    ("casters", |race| race.casters_ratio),
    ("shaded", |race| race.receivers_ratio),
    ("bare", |race| race.receivers_bare_ratio),
    ("bare, matrix at vertices", |race| race.receivers_vertex_ratio),
    ("whole, shaded", |race| race.whole_ratio),
    ("whole, bare", |race| race.whole_bare_ratio),
];

/// The library beside what is written by hand.
fn races(measured: &[Measured]) -> String {
    let mut text = format!(
        "Library / by hand, medians of {TURNS} ratios, each of neighbours in time. Casters: against a depth pass with one matrix. \
         Receivers (`fsm`, hardware 2×2, automatic bias, in two stages as `compare`, `mask` and `plug_in` draw them: \
         `antumbra_place` at vertices, `antumbra_lit` at fragments) against one matrix, one comparison sample and a constant bias:\n\n\
         - *shaded*: both sides shade what arrives with Lambert's cosine, for which an engine has the normal at hand;\n\
         - *bare*: neither side shades, and by hand nobody reads a normal;\n\
         - *bare, matrix at vertices*: as bare, with the matrix by hand moved to the vertex stage as well;\n\
         - *whole*: the library in one stage, `antumbra_visibility` at fragments, which smooth normals on large triangles need.\n\n"
    );
    let headings = RATIOS.map(|(heading, _)| heading).join(" | ");
    let _ = writeln!(text, "| scene | case | size | {headings} |\n|---|---|--:|{}", "--:|".repeat(RATIOS.len()));
    for scene in measured {
        for (case, size, race) in &scene.races {
            let cells = RATIOS.map(|(_, ratio)| format!("{:.3}", ratio(race))).join(" | ");
            let _ = writeln!(text, "| {} | {case} | {size} | {cells} |", scene.scene);
        }
    }
    let all = |ratio: Ratio| -> Vec<f64> {
        measured.iter().flat_map(|scene| &scene.races).map(|race| ratio(&race.2)).collect()
    };
    let medians = RATIOS.map(|(_, ratio)| format!("**{:.3}**", median_of(all(ratio)))).join(" | ");
    let _ = writeln!(text, "| all | median | | {medians} |");
    let ranges = RATIOS.map(|(_, ratio)| {
        let ratios = all(ratio);
        let (least, most) = (ratios.iter().copied().reduce(f64::min), ratios.iter().copied().reduce(f64::max));
        format!("{:.3} to {:.3}", least.unwrap_or(f64::NAN), most.unwrap_or(f64::NAN))
    });
    let _ = writeln!(text, "| all | range | | {} |\n", ranges.join(" | "));
    text
}

/// What the numbers do not say.
const BIAS: &str = "## Bias\n\n\
- Times are medians of repeated passes on the adapter named above. A software adapter runs shaders on the processor: its ratios of \
arithmetic to texture reads differ from a GPU's, and other work on the machine moves single times by tens of percent.\n\
- The scenes are this project's own, and its authors tuned on them; `compare` runs the same measurement on yours.\n\
- The time of a frame counts fit, casters and receivers, not what an engine does besides. The standard map of a still scene can be \
kept from frame to frame: its casters are then free, which the table does not credit.\n\
- Errors are against ray-traced truth at 800 × 600; larger pictures want larger maps.\n";
