//! How strong a warp pays: true error over κλ, on many scenes and viewpoints, map sizes 256 to 2048,
//! beside the named techniques.
//!
//! `cargo bench --bench warp_sweep` sweeps the built-in scenes and, where `ANTUMBRA_SCENES` names a folder, a tour of
//! every scene in it and the cases beside it. It writes `docs/WARPS.md` and the pictures of it; every run is kept as a
//! line of `target/warp_sweep/sweep.csv`.
//!
//! - `-- NAME` sweeps the cases whose `set/scene/case` contains NAME, into `target/warp_sweep` instead.
//! - `-- --quick` sweeps every fourth case at two sizes, into `target/warp_sweep` instead.
//! - `-- --page` measures nothing and writes the page of the last sweep again; with `--quick`, of the last part of one.

mod cells;
mod measure;
mod page;
mod pictures;
mod record;
mod words;

use std::path::{Path, PathBuf};
use std::time::Instant;

use antumbra::lab::cli;
use antumbra::lab::experiment::{Backend, BackendChoice};
use antumbra::lab::files::write_whole;

use crate::cells::Cells;
use crate::measure::Programme;
use crate::record::Sweep;

fn main() {
    cli::bench(run);
}

fn run() -> Result<(), String> {
    let has = |flag: &str| std::env::args().any(|argument| argument == flag);
    let only = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    // A part of the sweep never replaces the page of all of it.
    let part = has("--quick") || only.is_some();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let kept = root.join("target/warp_sweep");
    let (table, folder) =
        if part { (kept.join("part.csv"), kept) } else { (kept.join("sweep.csv"), root.join("docs")) };
    std::fs::create_dir_all(root.join("target/warp_sweep")).map_err(|error| format!("target/warp_sweep: {error}"))?;
    let sweep =
        if has("--page") { Sweep::read(&table)? } else { measure(&Programme::new(has("--quick"), only), &table)? };
    write(&sweep, &folder)
}

/// Sweeps, and keeps what was measured so far whenever a scene is through.
fn measure(programme: &Programme, table: &Path) -> Result<Sweep, String> {
    let start = Instant::now();
    let (mut backend, why_not) = Backend::open(BackendChoice::Auto)?;
    if let Some(why) = why_not {
        println!("{why}");
    }
    let mut sweep = Sweep::default();
    for (set, assignment) in programme.assignments()? {
        measure::sweep(&mut backend, programme, set, &assignment, &mut sweep)?;
        let meta = cli::provenance("warp_sweep", &programme.arguments(), backend.adapter(), start);
        sweep.meta = meta.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        sweep.write(table)?;
    }
    Ok(sweep)
}

/// Writes the page and its pictures.
fn write(sweep: &Sweep, folder: &Path) -> Result<(), String> {
    let cells = Cells::of(sweep)?;
    let named = |name: &str| -> PathBuf { folder.join(name) };
    write_whole(&named("warps-sweep.svg"), pictures::sweep(&cells).as_bytes())?;
    write_whole(&named("warps-predicted.svg"), pictures::predicted(&cells).as_bytes())?;
    write_whole(&named("errors-of-depth.svg"), pictures::errors_of_depth().as_bytes())?;
    write_whole(&named("WARPS.md"), page::page(sweep, &cells).as_bytes())?;
    println!("{} and beside it three pictures", named("WARPS.md").display());
    Ok(())
}
