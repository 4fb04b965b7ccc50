//! What the command lines of the examples share.

use std::process::ExitCode;

use clap::ValueEnum;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

use super::experiment::BackendChoice;
use crate::remix::Remix;
use crate::scene::MAX_SIDE;
use crate::techniques;

/// Exit code of bad input.
const BAD_INPUT: u8 = 2;

/// Prints a problem as one line and gives the exit code of bad input.
#[must_use]
pub fn fail(problem: &str) -> ExitCode {
    eprintln!("error: {}", problem.replace('\n', " "));
    ExitCode::from(BAD_INPUT)
}

/// `--backend`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BackendName {
    /// The GPU, or the software renderer where there is none.
    Auto,
    /// The GPU.
    Gpu,
    /// The software renderer.
    Cpu,
}

impl From<BackendName> for BackendChoice {
    fn from(name: BackendName) -> Self {
        match name {
            BackendName::Auto => Self::Auto,
            BackendName::Gpu => Self::Gpu,
            BackendName::Cpu => Self::Cpu,
        }
    }
}

/// A technique by name.
///
/// # Errors
/// One line with the names there are.
pub fn technique(name: &str) -> Result<Remix, String> {
    techniques::by_name(name).ok_or_else(|| {
        let names: Vec<&str> = techniques::NAMED.iter().map(|(name, _)| *name).collect();
        format!("technique is \"{name}\"; legal: {}", names.join(", "))
    })
}

/// The side of a map.
///
/// # Errors
/// One line with the legal range.
pub fn map_size(text: &str) -> Result<u32, String> {
    match text.trim().parse::<u32>() {
        Ok(side) if (1..=MAX_SIDE).contains(&side) => Ok(side),
        _ => Err(format!("size is \"{text}\"; legal: a whole number of texels from 1 to {MAX_SIDE}")),
    }
}

/// A picture as PNG bytes.
///
/// # Errors
/// One line, when the encoder refuses the picture.
pub fn encode_png(pixels: &[u8], width: u32, height: u32, colour: ExtendedColorType) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(pixels, width, height, colour)
        .map_err(|error| format!("cannot encode a picture of {width} x {height} pixels: {error}"))?;
    Ok(bytes)
}
