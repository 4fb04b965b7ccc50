//! Error against run time, measured against ray-traced truth: every named technique and every encoding, on every
//! built-in viewpoint and, with `ANTUMBRA_SCENES`, on the case files beside that folder.
//!
//! `cargo bench --bench work_precision` writes `docs/BENCHMARKS.md`, `docs/work_precision.csv` and
//! `docs/work_precision-*.svg`. With `-- --quick` it looks at one case a scene at half size, with `-- NAME` at the cases
//! whose `scene/case` contains that, and writes into `target/work_precision` instead.
//!
//! Contenders of one case and size are drawn turn by turn. The library's passes race against the same passes written by
//! hand (a depth pass with one matrix, a receiver with one comparison sample and a constant bias), in turns as well.

mod bias;
mod contenders;
mod measure;
mod page;
mod plots;
mod races;
mod summary;

use std::path::Path;
use std::time::Instant;

use antumbra::lab::bias_matrix::Picture;
use antumbra::lab::cli;
use antumbra::lab::experiment::{Backend, BackendChoice};
use antumbra::lab::files::write_whole;
use antumbra::lab::report::write_wide_csv;

use contenders::{Contender, contenders, sizes};
use measure::{Effort, Measured, Session, sets};

/// Turns of the contenders: the fewest whose quartiles are not the extremes. Five take a full run on two cores to the
/// 20 minutes that it may last.
const TURNS: u32 = 3;

/// Turns of the receivers beside nine comparisons, and those with large maps. The ratios are near 1: with five, one
/// disturbed turn moved a median by a fifth.
const NINE_TURNS: [u32; 2] = [11, 7];

/// Turns of a race.
const RACE_TURNS: u32 = 15;

/// All of them with `--quick`.
const QUICK_TURNS: u32 = 3;

/// Columns of the table after those of every table: quartiles of `total_ms` over the turns.
const MORE: [&str; 2] = ["total_q1_ms", "total_q3_ms"];

fn main() {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let only = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    cli::bench(|| run(quick, only.as_deref()));
}

fn run(quick: bool, only: Option<&str>) -> Result<(), String> {
    // Choose what is drawn.
    let start = Instant::now();
    let (mut backend, why_not) = Backend::open(BackendChoice::Auto)?;
    if let Some(why) = why_not {
        println!("{why}");
    }
    println!("{} ({})", backend.adapter(), backend.name());
    let contenders = contenders(&backend);
    let effort = if quick {
        let turns = QUICK_TURNS;
        Effort { sizes: sizes(quick), turns, nine_turns: [turns; 2], race_turns: turns }
    } else {
        Effort { sizes: sizes(quick), turns: TURNS, nine_turns: NINE_TURNS, race_turns: RACE_TURNS }
    };
    let mut sets = sets(only, if quick { 1 } else { usize::MAX })?;
    if quick {
        let cases = sets.iter_mut().flat_map(|(_, assignments)| assignments).flat_map(|of| &mut of.cases);
        cases.for_each(|case| case.viewport = case.viewport.map(|side| side.div_ceil(2)));
    }
    // Draw it.
    let mut session = Session { backend: &mut backend, contenders: &contenders, effort: &effort };
    let mut measured = Vec::new();
    for (set, assignments) in &sets {
        measured.push(session.measure(set, assignments)?);
    }
    let biases = bias::measure()?;
    // Write the table, the curves and the page.
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join(if quick || only.is_some() { "target/work_precision" } else { "docs" });
    let arguments: Vec<&str> = quick.then_some("--quick").into_iter().chain(only).collect();
    let meta = cli::provenance("work_precision", &arguments, backend.adapter(), start);
    write_all(&folder, &meta, &contenders, &effort, &measured, &biases)
}

fn write_all(
    folder: &Path,
    meta: &[(&'static str, String)],
    contenders: &[Contender],
    effort: &Effort,
    measured: &[Measured],
    biases: &Picture,
) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("cannot make {} ({error})", folder.display()))?;
    let rows: Vec<_> = measured
        .iter()
        .flat_map(|set| &set.records)
        .map(|record| (record.row.clone(), record.quartiles.to_vec()))
        .collect();
    let lines: Vec<(&str, &str)> = meta.iter().map(|(name, value)| (*name, value.as_str())).collect();
    write_wide_csv(&folder.join("work_precision.csv"), &lines, &MORE, &rows).map_err(|error| error.to_string())?;
    let cells: Vec<_> = measured.iter().map(|set| summary::cells(set, contenders, &effort.sizes)).collect();
    for (set, cells) in measured.iter().zip(&cells) {
        for (name, svg) in plots::plots(&set.set, cells) {
            write_whole(&folder.join(name), svg.as_bytes())?;
        }
    }
    let page = page::page(meta, effort, measured, &cells, biases);
    write_whole(&folder.join("BENCHMARKS.md"), page.as_bytes())?;
    println!("{} and beside it the table and the curves; {}", folder.join("BENCHMARKS.md").display(), lines[4].1);
    Ok(())
}
