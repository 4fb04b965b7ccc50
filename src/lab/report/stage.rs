//! Files that appear whole or not at all: written beside their place under a temporary name, then renamed.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::ReportError;
use crate::lab::files::open_beside;

/// A file that is complete but does not stand at its place yet; dropped, it leaves nothing behind.
pub(super) struct Staged {
    file: NamedTempFile,
    target: PathBuf,
}

/// Writes a file beside its place; its folder must exist.
pub(super) fn write(
    target: &Path,
    content: impl FnOnce(&mut BufWriter<&mut NamedTempFile>) -> io::Result<()>,
) -> Result<Staged, ReportError> {
    let unwritable = |source| ReportError::Unwritable { path: target.to_owned(), source };
    // Refuse a place that no rename can take.
    if target.is_dir() {
        return Err(ReportError::NotAFile { path: target.to_owned() });
    }
    // A bare file name lies in the current folder.
    let folder = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Write all of it before anything stands at its place.
    let mut file = open_beside(folder).map_err(unwritable)?;
    let mut sink = BufWriter::new(&mut file);
    content(&mut sink).and_then(|()| sink.flush()).map_err(unwritable)?;
    drop(sink);
    Ok(Staged { file, target: target.to_owned() })
}

/// Renames finished files to their places.
pub(super) fn publish(files: impl IntoIterator<Item = Staged>) -> Result<(), ReportError> {
    for Staged { file, target } in files {
        file.persist(&target).map_err(|error| ReportError::Unwritable { path: target, source: error.error })?;
    }
    Ok(())
}

/// Makes a folder and its parents, and sees that it is one.
pub(super) fn folder(path: &Path) -> Result<(), ReportError> {
    if path.exists() && !path.is_dir() {
        return Err(ReportError::NotAFolder { path: path.to_owned() });
    }
    fs::create_dir_all(path).map_err(|source| ReportError::Unwritable { path: path.to_owned(), source })
}
