//! One case, one technique, one map size: the shadow mask as a PNG, and what it took as JSON.
//!
//! ```sh
//! cargo run --release --example mask -- --case CASE.json --technique fsm --size 1024 --out mask.png --timing mask.json
//! ```

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use antumbra::lab::case::Case;
use antumbra::lab::cli::{BackendName, encode_png, fail, map_size, technique};
use antumbra::lab::experiment::{Backend, Shot, Studio, stage_names};
use antumbra::lab::files::{writable, write_whole};
use antumbra::lab::subject::{Setting, Subject};
use clap::Parser;
use serde_json::json;

/// Draws the shadow mask of one case: 8-bit grey, row 0 on top, 255 lit, 0 in shadow, sky 255.
///
/// A case is a JSON file with name, scene (treeline, sparse-city, or a .glb/.gltf path relative to the case's folder or
/// its parent), camera {eye, target, up, `fov_y_deg`, near, far}, light {kind: directional, travel}, viewport [w, h]
/// and `shadow_distance`. Bad input ends with one line and exit code 2, and writes nothing.
#[derive(Parser)]
#[command(version, after_help = "Example: mask --case street.json --technique fsm --size 1024 --out street.png")]
struct Arguments {
    /// The case file.
    #[arg(long, value_name = "FILE.json")]
    case: PathBuf,
    /// Technique by name, such as ssm, fsm, cascades or smra-plus: README.md lists all of them, and so does the error of a
    /// name that is none.
    #[arg(long, value_name = "NAME")]
    technique: String,
    /// Side of the map, texels, 1 to 16384.
    #[arg(long, value_name = "N")]
    size: String,
    /// Where the mask goes.
    #[arg(long, value_name = "MASK.png")]
    out: PathBuf,
    /// Where times, bytes and what was left out go.
    #[arg(long, value_name = "FILE.json")]
    timing: Option<PathBuf>,
    /// Renderer: auto takes the GPU where there is one.
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    backend: BackendName,
    /// How often each pass is drawn for its median time.
    #[arg(long, value_name = "N", default_value_t = 5)]
    repetitions: u32,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => fail(&problem),
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    // Check everything before anything is written.
    let technique = technique(&arguments.technique)?;
    let size = map_size(&arguments.size)?;
    let case = Case::load(&arguments.case).map_err(|error| error.to_string())?;
    let source = case.scene_source().map_err(|error| error.to_string())?;
    let subject = Subject::load(&source).map_err(|error| error.to_string())?;
    writable(&arguments.out)?;
    arguments.timing.as_deref().map_or(Ok(()), writable)?;
    let (mut backend, why_not) = Backend::open(arguments.backend.into())?;
    let technique = backend.adapted(&technique);
    // Draw.
    let shot = Studio::new(&mut backend, &subject, Setting::of(&case))
        .and_then(|mut studio| studio.shoot(&technique, size, arguments.repetitions))
        .map_err(|error| error.to_string())?;
    // Write.
    let [width, height] = case.viewport;
    write_whole(&arguments.out, &encode_png(&shot.mask, width, height, image::ExtendedColorType::L8)?)?;
    if let Some(path) = &arguments.timing {
        write_timing(path, arguments, &technique, &backend, size, &shot)?;
    }
    let fallback = why_not.map_or_else(String::new, |why| format!(" ({why})"));
    println!("{} at {size} on {}: {}{fallback}", arguments.technique, backend.adapter(), arguments.out.display());
    Ok(())
}

fn write_timing(
    path: &Path,
    arguments: &Arguments,
    technique: &antumbra::Remix,
    backend: &Backend,
    size: u32,
    shot: &Shot,
) -> Result<(), String> {
    let [split, warp, encoding] = stage_names(technique);
    let left_out: Vec<String> = shot.frame.left_out.iter().map(ToString::to_string).collect();
    let timing = json!({
        "technique": arguments.technique, "split": split, "warp": warp, "encoding": encoding,
        "size": size, "views": shot.frame.views.len(), "bytes": shot.bytes,
        "backend": backend.name(), "adapter": backend.adapter(), "repetitions": arguments.repetitions,
        "fit_ns": shot.fit_ns, "casters_ms": shot.casters_ms, "filter_ms": shot.filter_ms,
        "receivers_ms": shot.receivers_ms,
        "total_ms": shot.fit_ns * 1e-6 + shot.casters_ms + shot.filter_ms + shot.receivers_ms,
        "left_out": left_out,
    });
    write_whole(path, format!("{timing:#}\n").as_bytes())
}
