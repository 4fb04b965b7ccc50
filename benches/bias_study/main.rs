//! Self-shadowing and detachment, measured: none, constant, slope-scaled and automatic bias in linear depth, projective
//! depth and maps of back faces alone; and a sweep of constant biases on the Utah teapot under two lights.
//! `cargo bench --bench bias_study` writes `docs/BIAS.md`, its plots, and pictures to `target/bias_study`.

mod gz;
mod matrix;
mod page;

use std::path::{Path, PathBuf};
use std::time::Instant;

use antumbra::lab::cli::{self, encode_png};
use antumbra::lab::files::write_whole;
use antumbra::lab::metrics::{heat_map, mask_from_bytes};
use antumbra::lab::truth::Truth;
use image::ExtendedColorType;

/// Keeps a picture and what is wrong with it, to be looked at.
pub(crate) fn save(name: &str, mask: &[u8], truth: &Truth) -> Result<(), String> {
    let folder: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/bias_study");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let errors = heat_map(&mask_from_bytes(mask), truth).map_err(|error| error.to_string())?;
    let name = name.replace(['/', ' ', ','], "-");
    for (suffix, pixels, colours) in
        [("", mask, ExtendedColorType::L8), ("-errors", errors.as_slice(), ExtendedColorType::Rgb8)]
    {
        let png = encode_png(pixels, truth.width, truth.height, colours)?;
        write_whole(&folder.join(format!("{name}{suffix}.png")), &png)?;
    }
    Ok(())
}

fn main() {
    cli::bench(run);
}

fn run() -> Result<(), String> {
    let start = Instant::now();
    let sweep = gz::sweep()?;
    let pictures = matrix::pictures()?;
    let meta = [
        ("command", format!("cargo {} --bench bias_study", if cfg!(debug_assertions) { "test" } else { "bench" })),
        ("commit", cli::commit()),
        ("renderer", format!("software renderer, {} threads", rayon_threads())),
        ("date", cli::now()),
        ("took", format!("{:.0} s", start.elapsed().as_secs_f64())),
    ];
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    for (name, svg) in page::plots(&sweep) {
        write_whole(&docs.join(name), svg.as_bytes())?;
    }
    write_whole(&docs.join("BIAS.md"), page::page(&meta, &sweep, &pictures).as_bytes())
}

fn rayon_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
