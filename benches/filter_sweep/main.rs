//! Maps of moments beside percentage-closer filtering at the same width: time on the adapter, error against the truth,
//! and distance from the picture that comparing first and averaging then gives. `cargo bench --bench filter_sweep`
//! writes `docs/FILTERS.md`, its plots and `target/filter_sweep/sweep.csv`; `-- --quick` runs two cases and three
//! widths, and writes the table alone.

mod contenders;
mod measure;
mod page;

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use antumbra::lab::cli;
use antumbra::lab::comparison::{Assignment, shared_scenes};
use antumbra::lab::files::write_whole;
use antumbra::lab::gpu::Gpu;

use measure::{Bench, Record};

/// Side of the map, texels.
pub(crate) const SIDE: u32 = 1024;

/// Widths of filters, texels.
const WIDTHS: [u32; 7] = [3, 5, 7, 9, 15, 21, 31];

/// The same with `--quick`.
const QUICK_WIDTHS: [u32; 3] = [5, 15, 31];

/// Cases that are photographed: one of each shared scene's kind, and of the built-in scenes. All of them would take an
/// hour on a software driver.
const CASES: [&str; 4] = ["fence-general", "columns-row", "treeline/across", "sparse-city/figure"];

/// The same with `--quick`.
const QUICK_CASES: [&str; 2] = ["columns-row", "treeline/across"];

/// Turns that every contender gets: the fewest whose quartiles are turns of their own, neither median nor extreme.
const TURNS: u32 = 5;

/// The same with `--quick`.
const QUICK_TURNS: u32 = 3;

fn assignments(wanted: &[&str]) -> Result<Vec<Assignment>, String> {
    let mut assignments = Vec::new();
    if let Some(scenes) = shared_scenes() {
        let folder = scenes.join("../cases");
        for name in wanted.iter().filter(|name| !name.contains('/')) {
            assignments.push(Assignment::of_case(&folder.join(format!("{name}.json")))?);
        }
    }
    for scene in ["treeline", "sparse-city"] {
        let mut assignment = Assignment::of_scene(scene)?;
        assignment.cases.retain(|case| wanted.contains(&format!("{scene}/{}", case.name).as_str()));
        assignment.cases.iter_mut().for_each(|case| case.name = format!("{scene}/{}", case.name));
        assignments.push(assignment);
    }
    Ok(assignments)
}

fn csv(records: &[Record]) -> String {
    let mut text = "case,width,technique,filter_ms,filter_spread_ms,receivers_ms,receivers_spread_ms,total_ms,total_spread_ms,mae,\
                    excess,distance,leak,false\n"
        .to_owned();
    for record in records {
        let Record { case, width, name, filter, receivers, total, mae, excess, distance, leak, acne } = record;
        let times = [filter, receivers, total].map(|time| format!("{},{}", time.ms, time.spread)).join(",");
        let _ = writeln!(text, "{case},{width},\"{name}\",{times},{mae},{excess},{distance},{leak},{acne}");
    }
    text
}

fn main() {
    cli::bench(run);
}

fn run() -> Result<(), String> {
    let start = Instant::now();
    let quick = std::env::args().any(|argument| argument == "--quick");
    let gpu = Gpu::new().map_err(|error| error.to_string())?;
    let (cases, widths, turns) =
        if quick { (&QUICK_CASES[..], &QUICK_WIDTHS[..], QUICK_TURNS) } else { (&CASES[..], &WIDTHS[..], TURNS) };
    let mut bench = Bench::new(&gpu, turns);
    for assignment in assignments(cases)? {
        for case in &assignment.cases {
            bench.run(&assignment, case, widths)?;
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join("target/filter_sweep");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    write_whole(&folder.join("sweep.csv"), csv(&bench.records).as_bytes())?;
    let arguments: &[&str] = if quick { &["--quick"] } else { &[] };
    let meta = cli::provenance("filter_sweep", arguments, gpu.adapter().to_owned(), start);
    let memory = contenders::memory(&gpu)?;
    let text = page::page(&meta, turns, &bench.records, &memory);
    if quick {
        println!("{text}");
        return Ok(());
    }
    for (name, svg) in page::plots(&bench.records) {
        write_whole(&root.join("docs").join(name), svg.as_bytes())?;
    }
    write_whole(&root.join("docs/FILTERS.md"), text.as_bytes())
}
