//! Writing files so that nothing half-written is left behind.

use std::io::Write;
use std::path::Path;

/// Writes a file as a whole: into a temporary file beside it, which then takes its place.
///
/// # Errors
/// One line that names the path and what is legal.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), String> {
    let problem = |error: &dyn std::fmt::Display| {
        format!(
            "cannot write {} ({error}); legal: a file in a folder that exists and may be written to",
            path.display()
        )
    };
    if path.is_dir() {
        return Err(problem(&"it is a folder"));
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut file = tempfile::NamedTempFile::new_in(folder).map_err(|error| problem(&error))?;
    file.write_all(content).map_err(|error| problem(&error))?;
    file.persist(path).map_err(|error| problem(&error.error))?;
    Ok(())
}
