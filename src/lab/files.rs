//! Writing files so that nothing half-written is left behind.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Checks that a file can be written, and leaves no trace.
///
/// # Errors
/// One line that names the path and what is legal.
pub fn writable(path: &Path) -> Result<(), String> {
    beside(path).map(drop)
}

/// Writes a file as a whole: into a temporary file beside it, which then takes its place.
///
/// # Errors
/// One line that names the path and what is legal.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), String> {
    let mut file = beside(path)?;
    file.write_all(content).map_err(|error| problem(path, &error))?;
    file.persist(path).map_err(|error| problem(path, &error.error))?;
    Ok(())
}

/// The files of a folder with an extension (no dot), by name.
///
/// # Errors
/// One line that names the folder.
pub fn with_extension(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, String> {
    let unreadable = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        found.push(entry.map_err(unreadable)?.path());
    }
    found.retain(|path| path.extension().is_some_and(|found| found == extension));
    found.sort();
    Ok(found)
}

/// A temporary file in the folder that a path is in.
fn beside(path: &Path) -> Result<NamedTempFile, String> {
    if path.is_dir() {
        return Err(problem(path, &"it is a folder"));
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    open_beside(folder).map_err(|error| problem(path, &error))
}

fn problem(path: &Path, reason: &dyn std::fmt::Display) -> String {
    format!("cannot write {} ({reason}); legal: a file in a folder that exists and may be written to", path.display())
}

/// Opens a temporary file with the rights that an ordinary new file gets.
pub(crate) fn open_beside(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".antumbra-");
    // Temporary files are private by default; a picture or a report is meant to be shared. The umask still applies.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
