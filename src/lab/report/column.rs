//! What each column of a [`Row`] is called, measured in, means, and how its figures are written for people.

use super::row::Row;

/// One column of a table: its name in `results.csv`, its heading for people, and how to read it from a row.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Name in `results.csv` (or of a derived figure, such as `excess`).
    pub name: &'static str,
    /// Heading of a table that people read.
    pub heading: &'static str,
    /// Unit of the printed figure; empty for text and for counts.
    pub unit: &'static str,
    /// One or two sentences: what it is, and which end is good.
    pub meaning: &'static str,
    /// Value of the column in a row.
    pub cell: fn(&Row) -> Cell<'_>,
}

/// A value of a [`Column`].
#[derive(Clone, Copy, Debug)]
pub enum Cell<'a> {
    /// A name.
    Text(&'a str),
    /// Lines of text.
    Lines(&'a [String]),
    /// A whole number.
    Count(u64),
    /// Memory in bytes, printed in KiB or MiB.
    Bytes(u64),
    /// A time in nanoseconds.
    Nanoseconds(f64),
    /// A time in milliseconds.
    Milliseconds(f64),
    /// A difference of light, 0..1.
    Difference(f64),
    /// A share, 0..1, printed in percent.
    Share(f64),
    /// A length in screen pixels.
    Pixels(f64),
}

/// Bytes of one KiB.
pub(super) const KIB: f64 = 1024.0;
/// Below this a difference is printed as a power of ten, as four decimals would leave fewer than two digits of it.
const SMALL_DIFFERENCE: f64 = 1e-3;
/// Below this (percent) a share is printed as a power of ten, as two decimals would hide it.
const SMALL_PERCENT: f64 = 0.01;

impl Cell<'_> {
    /// The number to sort by; `None` for text.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match *self {
            Self::Text(_) | Self::Lines(_) => None,
            #[expect(clippy::cast_precision_loss, reason = "sorting and plotting need no more than 53 bits")]
            Self::Count(n) | Self::Bytes(n) => Some(n as f64),
            Self::Nanoseconds(v) | Self::Milliseconds(v) | Self::Difference(v) | Self::Share(v) | Self::Pixels(v) => {
                Some(v)
            }
        }
    }

    /// The value as people read it, without its unit (bytes carry theirs); a figure that was not measured is `NaN`.
    #[must_use]
    pub fn text(&self) -> String {
        match *self {
            Self::Text(text) => text.to_owned(),
            Self::Lines(lines) => lines.join("; "),
            Self::Count(n) => grouped(n),
            Self::Bytes(n) => bytes(n),
            _ if self.number().is_some_and(f64::is_nan) => "NaN".to_owned(),
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "`as` saturates; times are >= 0"
            )]
            Self::Nanoseconds(v) => grouped(v.round() as u64),
            Self::Milliseconds(v) => milliseconds(v),
            Self::Difference(v) => decimals_or_power(v, SMALL_DIFFERENCE, 4),
            Self::Share(v) => decimals_or_power(v * 100.0, SMALL_PERCENT, 2),
            Self::Pixels(v) => decimals_or_power(v, SMALL_PERCENT, 2),
        }
    }
}

/// Writes a whole number; from five digits on, with a thin space between groups of three.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut text = String::with_capacity(digits.len() * 2);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Writes memory in KiB, or in MiB from one MiB on.
fn bytes(n: u64) -> String {
    #[expect(clippy::cast_precision_loss, reason = "printed to three digits")]
    let kib = n as f64 / KIB;
    if n == 0 {
        "0".to_owned()
    } else if kib < KIB {
        format!("{kib:.0} KiB")
    } else {
        format!("{:.1} MiB", kib / KIB)
    }
}

/// Writes a time with three digits or so.
fn milliseconds(v: f64) -> String {
    match v.abs() {
        a if a >= 100.0 => format!("{v:.0}"),
        a if a >= 10.0 => format!("{v:.1}"),
        a if a >= 1.0 => format!("{v:.2}"),
        0.0 => "0".to_owned(),
        _ => format!("{v:.3}"),
    }
}

/// Writes with so many decimals, or as a power of ten when the decimals would hide the figure.
fn decimals_or_power(v: f64, small: f64, decimals: usize) -> String {
    if v == 0.0 {
        "0".to_owned()
    } else if v.abs() < small {
        format!("{v:.1e}")
    } else {
        format!("{v:.decimals$}")
    }
}

/// Shorthand of the table below.
const fn column(
    name: &'static str,
    heading: &'static str,
    unit: &'static str,
    meaning: &'static str,
    cell: fn(&Row) -> Cell<'_>,
) -> Column {
    Column { name, heading, unit, meaning, cell }
}

/// Every column that a table may show: those of `results.csv` in order, then the derived `excess`.
pub const COLUMNS: [Column; 30] = [
    column("scene", "scene", "", "Scene: built in, or the stem of a file.", |r| Cell::Text(&r.scene)),
    column("case", "case", "", "Camera and light within the scene.", |r| Cell::Text(&r.case)),
    column("technique", "technique", "", "Technique as named on the command line.", |r| Cell::Text(&r.technique)),
    column("split", "split", "", "How many maps there are and where they part.", |r| Cell::Text(&r.split)),
    column("warp", "warp", "", "How texels are spread within a map.", |r| Cell::Text(&r.warp)),
    column("encoding", "encoding", "", "What a texel stores and how it is filtered.", |r| Cell::Text(&r.encoding)),
    column("size", "size", "", "Side of one map asked for, in texels.", |r| Cell::Count(r.size.into())),
    column("views", "views", "", "Maps that were drawn.", |r| Cell::Count(r.views.into())),
    column("texels", "texels", "", "Texels of all maps together.", |r| Cell::Count(r.texels)),
    column("bytes", "memory", "", "Map memory, filtered copies included.", |r| Cell::Bytes(r.bytes)),
    column("backend", "backend", "", "Renderer that ran: gpu or cpu.", |r| Cell::Text(&r.backend)),
    column("adapter", "adapter", "", "Adapter or processor that ran it.", |r| Cell::Text(&r.adapter)),
    column("fit_ns", "fit", "ns", "CPU time of one fit: from camera, light and scene to matrices.", |r| {
        Cell::Nanoseconds(r.fit_ns)
    }),
    column("casters_ms", "casters", "ms", "Time to draw the casters into the maps.", |r| {
        Cell::Milliseconds(r.casters_ms)
    }),
    column("filter_ms", "filter", "ms", "Time to filter the maps; 0 where the encoding needs none.", |r| {
        Cell::Milliseconds(r.filter_ms)
    }),
    column("receivers_ms", "receivers", "ms", "Time to shade the picture, lookups included.", |r| {
        Cell::Milliseconds(r.receivers_ms)
    }),
    column("total_ms", "total", "ms", "Time of the whole frame. Less is better.", |r| Cell::Milliseconds(r.total_ms)),
    column(
        "rmse",
        "rmse",
        "",
        "Root mean square difference from the area truth, 0 to 1. Weighs big mistakes more.",
        |r| Cell::Difference(r.rmse),
    ),
    column("mae", "mae", "", "Mean absolute difference from the area truth, 0 to 1. Compare it with the floor.", |r| {
        Cell::Difference(r.mae)
    }),
    column(
        "floor_mae",
        "floor",
        "",
        "The mae of a perfect lookup with one sample per pixel: unfiltered techniques can hardly pass it.",
        |r| Cell::Difference(r.floor_mae),
    ),
    column("wrong", "wrong", "%", "Pixels more than one half away from the area truth.", |r| Cell::Share(r.wrong)),
    column(
        "wrong_center",
        "wrong (centre)",
        "%",
        "Pixels more than one half away from the centre truth; a perfect single sample scores 0.",
        |r| Cell::Share(r.wrong_center),
    ),
    column(
        "edge_center_px",
        "edge shift",
        "px",
        "How far shadow edges that lie on one surface have moved, against the centre truth.",
        |r| Cell::Pixels(r.edge_center_px),
    ),
    column(
        "leak_edge",
        "leak, edge",
        "",
        "Light where there is none, within 2 px of an edge of the true shadow, 0 to 1.",
        |r| Cell::Difference(r.leak_edge),
    ),
    column(
        "leak_interior",
        "leak, inside",
        "",
        "Light where there is none, deeper inside the true shadow (light bleeding), 0 to 1.",
        |r| Cell::Difference(r.leak_interior),
    ),
    column(
        "false_edge",
        "false, edge",
        "",
        "Shadow where there is none, within 2 px of an edge of the true shadow, 0 to 1.",
        |r| Cell::Difference(r.false_edge),
    ),
    column(
        "false_interior",
        "false, open",
        "",
        "Shadow where there is none, further out in the light (acne), 0 to 1.",
        |r| Cell::Difference(r.false_interior),
    ),
    column(
        "predicted_px",
        "predicted",
        "px",
        "Footprint that the fit predicted before anything was drawn: screen pixels per texel.",
        |r| Cell::Pixels(r.predicted_px),
    ),
    column(
        "left_out",
        "left out",
        "",
        "What the technique left out, clamped or fell back from, and why; the error of a failed run.",
        |r| Cell::Lines(&r.left_out),
    ),
    column(
        "excess",
        "excess",
        "",
        "mae above the floor: the figure for filtered techniques. Below 0, filtering beats a single sample.",
        |r| Cell::Difference(r.excess()),
    ),
];

/// The column of this name.
#[must_use]
pub(super) fn find(name: &str) -> Option<&'static Column> {
    COLUMNS.iter().find(|column| column.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_written_for_people() {
        assert_eq!(Cell::Count(4_194_304).text(), "4\u{202f}194\u{202f}304");
        assert_eq!(Cell::Count(4096).text(), "4096");
        assert_eq!(Cell::Bytes(1024 * 1024).text(), "1.0 MiB");
        assert_eq!(Cell::Bytes(2048).text(), "2 KiB");
        assert_eq!(Cell::Milliseconds(0.1234).text(), "0.123");
        assert_eq!(Cell::Milliseconds(12.34).text(), "12.3");
        assert_eq!(Cell::Difference(0.000_124).text(), "1.2e-4");
        assert_eq!(Cell::Difference(-0.02).text(), "-0.0200");
        assert_eq!(Cell::Share(0.0123).text(), "1.23");
        assert_eq!(Cell::Share(f64::NAN).text(), "NaN");
        assert_eq!(Cell::Nanoseconds(f64::NAN).text(), "NaN");
        assert_eq!(Cell::Nanoseconds(12_400.4).text(), "12\u{202f}400");
    }

    #[test]
    fn names_are_unique() {
        for (i, a) in COLUMNS.iter().enumerate() {
            assert!(COLUMNS[i + 1..].iter().all(|b| b.name != a.name), "{} twice", a.name);
        }
    }
}
