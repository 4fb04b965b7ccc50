//! The report of a comparison: `results.csv`, error–time plots and one self-contained `index.html`.
//!
//! A [`Report`] holds what was run and the rows and pictures of every scene; [`write_report`] puts it in a folder. The
//! pieces also serve alone: [`write_csv`] and [`read_csv`] for records, [`error_time_svg`] for a plot,
//! [`markdown_table`] for a page.

mod column;
mod csv;
mod curves;
mod diagram;
mod gallery;
mod html;
mod markdown;
mod overview;
mod plot;
mod plot_front;
mod plot_marks;
mod plot_scale;
mod row;
mod stage;
mod table;

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

pub use column::{COLUMNS, Cell, Column};
pub use csv::{header, read_csv, write_csv, write_wide_csv};
pub use diagram::{Diagram, Layer, Look, Spot, Tick, diagram_svg};
pub use html::write_html;
pub use markdown::markdown_table;
pub use plot::{Axes, Axis, Floor, PlotPoint, Series, error_time_svg};
pub use row::Row;

/// File name of the page within the report's folder.
pub const INDEX_FILE: &str = "index.html";
/// File name of the table within the report's folder.
pub const RESULTS_FILE: &str = "results.csv";

/// Everything that one comparison has to tell.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Headline of the page.
    pub title: String,
    /// Command line that makes this report again.
    pub command: String,
    /// Commit (or version) that was run; say so when the tree was changed.
    pub commit: String,
    /// Adapter (or processor) that ran it.
    pub adapter: String,
    /// When it started, as people write a date.
    pub started: String,
    /// How long all of it took.
    pub duration: Duration,
    /// What a reader must know before believing the figures: one paragraph each.
    pub notes: Vec<String>,
    /// What the colours of the error pictures mean, in words; empty when there are none.
    pub heat_legend: String,
    /// Scenes and cases, in the order they are shown.
    pub scenes: Vec<SceneSection>,
}

/// One case of one scene: the truth, a picture per run, and the rows.
#[derive(Clone, Debug, Default)]
pub struct SceneSection {
    /// Scene: a built-in name or the stem of the file it came from.
    pub scene: String,
    /// Case: the name of the camera and light within the scene.
    pub case: String,
    /// What is to be seen, and what is hard about it.
    pub description: String,
    /// PNG of the area truth (white lit, black in shadow); empty when there is none.
    pub truth_png: Vec<u8>,
    /// Pictures of the runs, in the order they are shown.
    pub pictures: Vec<Picture>,
    /// Rows of this case, one per run, failed ones included.
    pub rows: Vec<Row>,
}

/// What one run drew.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// Technique, as in [`Row::technique`].
    pub technique: String,
    /// Side of one map, texels, as in [`Row::size`].
    pub size: u32,
    /// PNG of the shadow mask, of the truth's size; empty when there is none.
    pub png: Vec<u8>,
    /// PNG of the error against the truth, of the same size; empty when there is none.
    pub heat_png: Vec<u8>,
    /// PNG of the texels over a pixel, of the same shape and maybe coarser; empty when there is none.
    pub footprint_png: Vec<u8>,
    /// What was measured of that, and predicted; may be empty.
    pub footprint: String,
    /// A line to show under the picture; may be empty.
    pub caption: String,
}

impl Report {
    /// Every row of every scene, in order.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.scenes.iter().flat_map(|section| &section.rows)
    }
}

/// Why a report or a table could not be written or read.
#[derive(Debug)]
#[non_exhaustive]
pub enum ReportError {
    /// The folder to write to is something else.
    NotAFolder {
        /// Where.
        path: PathBuf,
    },
    /// A folder stands where the file should go.
    NotAFile {
        /// Where.
        path: PathBuf,
    },
    /// The file or folder cannot be written.
    Unwritable {
        /// Where.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file cannot be opened.
    Unreadable {
        /// Where.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is not a table with the columns of `results.csv`.
    NotOurTable {
        /// Where.
        path: PathBuf,
        /// Which line and cell.
        source: Box<::csv::Error>,
    },
    /// No column has this name.
    UnknownColumn {
        /// The name asked for.
        name: String,
    },
}

impl std::fmt::Display for ReportError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotAFolder { path } => {
                write!(f, "{} is not a folder: name a folder, or a path where one can be made", path.display())
            }
            Self::NotAFile { path } => {
                write!(f, "{} is a folder: name a file, or a path where one can be made", path.display())
            }
            Self::Unwritable { path, source } => {
                write!(f, "cannot write {} ({source}): name a path that this user may write to", path.display())
            }
            Self::Unreadable { path, source } => {
                write!(f, "cannot read {} ({source}): name a readable {RESULTS_FILE}", path.display())
            }
            Self::NotOurTable { path, source } => {
                write!(f, "{} is no table of results ({source}): columns are ", path.display())?;
                list(f, header())
            }
            Self::UnknownColumn { name } => {
                write!(f, "no column is named {name:?}: columns are ")?;
                list(f, COLUMNS.iter().map(|column| column.name))
            }
        }
    }
}

impl std::error::Error for ReportError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Unwritable { source, .. } | Self::Unreadable { source, .. } => Some(source),
            Self::NotOurTable { source, .. } => Some(source),
            Self::NotAFolder { .. } | Self::NotAFile { .. } | Self::UnknownColumn { .. } => None,
        }
    }
}

/// Writes names with commas between them.
fn list(f: &mut std::fmt::Formatter<'_>, names: impl Iterator<Item = &'static str>) -> std::fmt::Result {
    for (i, name) in names.enumerate() {
        write!(f, "{}{name}", if i == 0 { "" } else { ", " })?;
    }
    Ok(())
}

/// Writes `index.html` and `results.csv` into a folder, which is made when it does not exist.
///
/// Both files are complete before either takes its place, and other files in the folder stay as they are.
///
/// # Errors
/// [`ReportError`] naming the path that is not a folder or cannot be written.
pub fn write_report(dir: &Path, report: &Report) -> Result<(), ReportError> {
    // Make sure that there is a folder.
    stage::folder(dir)?;
    // Write both files under temporary names, so that a full disk leaves an older report whole.
    let table = stage::write(&dir.join(RESULTS_FILE), |sink| csv::write_rows(sink, &[], report.rows()))?;
    let page = stage::write(&dir.join(INDEX_FILE), |sink| write_html(sink, report))?;
    // Let them take their places.
    stage::publish([table, page])
}

#[cfg(test)]
mod tests;
