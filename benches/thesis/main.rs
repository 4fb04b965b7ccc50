//! The experiment of the thesis, run again: SSM, TSM, PSSM, VSM, SMRA and SMRA plus on its two scenes at its three map
//! sizes, against ray-traced truth; its Table 1 as numbers, its Table 2 pass by pass, and one change at a time.
//!
//! `cargo bench --bench thesis` writes `docs/THESIS.md` and the pictures of it in `docs/thesis`; where
//! `ANTUMBRA_SCENES` names a folder, the cases beside it take part. `-- --quick` looks at one viewpoint of each scene,
//! two cases and two sizes, and writes into `target/thesis` instead.

mod ablation;
mod artefacts;
mod claims;
mod classes;
mod duel;
mod maps;
mod measure;
mod montage;
mod page;
mod peers;
mod pictures;
mod plus;
mod programme;
mod times;

use std::path::Path;
use std::time::Instant;

use antumbra::lab::cli;
use antumbra::lab::experiment::{Backend, BackendChoice};
use antumbra::lab::files::write_whole;

use crate::measure::Results;
use crate::programme::Programme;

fn main() {
    cli::bench(run);
}

fn run() -> Result<(), String> {
    let start = Instant::now();
    let programme = Programme { quick: std::env::args().any(|argument| argument == "--quick") };
    let (mut backend, why_not) = Backend::open(BackendChoice::Auto)?;
    if let Some(why) = why_not {
        println!("{why}");
    }
    // Photograph and time.
    let mut results = Results::default();
    measure::built_in(&mut backend, &programme, &mut results)?;
    measure::shared(&mut backend, &programme, &mut results)?;
    // Write pictures, then the page that shows them.
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = if programme.quick { root.join("target/thesis") } else { root.join("docs") };
    let (harm, worst) = (claims::most_harm(&results.records)?, plus::worst(&results.records)?);
    let shown = [&harm, &worst];
    pictures::write(&programme, &mut results, &shown, &docs)?;
    let arguments: &[&str] = if programme.quick { &["--quick"] } else { &[] };
    let mut meta = cli::provenance("thesis", arguments, backend.adapter(), start);
    meta.extend((results.traced > 0).then(|| ("truths traced in that time", results.traced.to_string())));
    write_whole(&docs.join("THESIS.md"), page::page(&meta, &results, shown)?.as_bytes())?;
    println!("{}", docs.join("THESIS.md").display());
    Ok(())
}
