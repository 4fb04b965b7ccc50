//! What the command lines of the examples share.

use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use clap::ValueEnum;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

use super::comparison::{SCENES, shared_scenes};
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

/// Checks that a folder can be made and written to, and leaves no trace when it was not there.
///
/// # Errors
/// One line that names the path and what is legal.
pub fn writable_folder(path: &Path) -> Result<(), String> {
    let problem = |error: &dyn std::fmt::Display| {
        format!("cannot write to {} ({error}); legal: a folder, or a path where one can be made", path.display())
    };
    // The nearest thing on the way that exists has to be a folder that lets a file be made in it.
    let existing = path.ancestors().find(|ancestor| ancestor.exists()).unwrap_or_else(|| Path::new("."));
    if !existing.is_dir() {
        return Err(problem(&format!("{} is a file", existing.display())));
    }
    tempfile::NamedTempFile::new_in(existing).map_err(|error| problem(&error))?;
    Ok(())
}

/// The time now, seconds since 1970 as a date and time in UTC.
#[must_use]
pub fn now() -> String {
    let seconds = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let [year, month, day] = civil(days);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02} UTC", rest / 3600, rest / 60 % 60)
}

/// Year, month and day of a number of days since 1970-01-01 (Gregorian; H. Hinnant, *chrono-compatible low-level date
/// algorithms*, `civil_from_days`).
fn civil(days: u64) -> [u64; 3] {
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    [year_of_era + era * 400 + u64::from(month <= 2), month, day]
}

/// What a bench's results depend on. Others are not: a page that one bench writes says nothing of the next one.
const SOURCES: [&str; 5] = ["src", "shaders", "benches", "Cargo.toml", "Cargo.lock"];

/// The commit this was built from, where git can tell; `-dirty` where what a result depends on is not as committed.
#[must_use]
pub fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let changed = git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat());
    match (git(&["describe", "--always", "--exclude=*"]), changed) {
        (Some(commit), Some(changed)) => commit + if changed.is_empty() { "" } else { "-dirty" },
        _ => "unknown".to_owned(),
    }
}

/// Runs a bench; a problem is printed, and ends the process with 2. `cargo test --benches` only wants to know that it
/// builds and starts.
pub fn bench(run: impl FnOnce() -> Result<(), String>) {
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    if let Err(problem) = run() {
        eprintln!("error: {problem}");
        std::process::exit(2);
    }
}

/// The command line that runs a bench again, with what it saw of the environment.
#[must_use]
pub fn bench_command(bench: &str, arguments: &[&str]) -> String {
    let scenes = if shared_scenes().is_some() { format!("{SCENES}=<folder> ") } else { String::new() };
    let profile = if cfg!(debug_assertions) { "test" } else { "bench" };
    let arguments = if arguments.is_empty() { String::new() } else { format!(" -- {}", arguments.join(" ")) };
    format!("{scenes}cargo {profile} --bench {bench}{arguments}")
}

/// Where the numbers of a bench that began at `start` come from, by name: `command`, `commit`, `adapter`, `date` and
/// `took`, the seconds until now.
#[must_use]
pub fn provenance(bench: &str, arguments: &[&str], adapter: String, start: Instant) -> Vec<(&'static str, String)> {
    vec![
        ("command", bench_command(bench, arguments)),
        ("commit", commit()),
        ("adapter", adapter),
        ("date", now()),
        ("took", format!("{:.0} s", start.elapsed().as_secs_f64())),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates() {
        assert_eq!(civil(0), [1970, 1, 1]);
        assert_eq!(civil(11_016), [2000, 2, 29]);
        assert_eq!(civil(20_778), [2026, 11, 21]);
    }

    #[test]
    fn a_page_says_where_it_comes_from() {
        let page = provenance("b", &["--quick", "x"], "none".to_owned(), Instant::now());
        let names: Vec<&str> = page.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["command", "commit", "adapter", "date", "took"]);
        assert!(page[0].1.ends_with("--bench b -- --quick x"), "{}", page[0].1);
        assert!(bench_command("b", &[]).ends_with("--bench b"));
        assert_eq!((page[2].1.as_str(), page[4].1.as_str()), ("none", "0 s"));
    }

    #[test]
    fn problems_name_what_is_legal() {
        assert!(technique("nsm").unwrap_err().contains("ssm, fsm"));
        for bad in ["0", "16385", "-1", "x", "", "1e3", "NaN"] {
            assert!(map_size(bad).unwrap_err().contains("1 to 16384"), "{bad}");
        }
        assert_eq!(map_size(" 512").unwrap(), 512);
    }
}
