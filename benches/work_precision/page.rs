//! The page.

use std::fmt::Write as _;

use antumbra::lab::bias_matrix::Picture;
use antumbra::lab::comparison::shared_scenes;
use antumbra::lab::report::Row;

use crate::contenders::{FEW, LARGE};
use crate::measure::{Effort, Measured, WORST_WRONG};
use crate::summary::{Cell, FIGURES};
use crate::{bias, plots, races};

const HEAD: &str = "# Error against run time

This page is written by the command below; every number on it comes from that run.
";

/// Where there are no shared cases.
const WITHOUT_SHARED: &str = "**The shared cases are missing**: `ANTUMBRA_SCENES` named no folder of scenes beside which they lie, and medians over \
all pictures are of the built-in ones alone.\n\n";

/// What the numbers do not say.
const ITSELF: &str = "
### Of this page

- Times are medians of repeated passes on the adapter named above. A software adapter runs shaders on the processor: its ratios of \
arithmetic to texture reads differ from a GPU's, and other work on the machine moves single times by tens of percent.
- The built-in scenes are this project's own, and its authors tuned on them and on the shared cases; `compare` runs the same measurement
on yours.
- The time of a frame counts fit, casters, filter and receivers, not what an engine does besides. The standard map of a still scene can be
kept from frame to frame: its casters are then free, which the tables do not credit.
- Errors are against the ray-traced truth of a light without size, at 800 × 600 but for case files that say otherwise; larger pictures want
larger maps. Filters soften what such a truth has hard, soft shadows (`cascades pcss`) on purpose.
- A median over cases hides the worst of them; the table of every run is [work_precision.csv](work_precision.csv).
";

pub(crate) fn page(
    meta: &[(&'static str, String)],
    effort: &Effort,
    measured: &[Measured],
    cells: &[Vec<Cell>],
    biases: &Picture,
) -> String {
    let mut text = HEAD.to_owned();
    text.push('\n');
    for (name, value) in meta {
        let _ = writeln!(text, "- {name}: `{value}`");
    }
    text.push('\n');
    races::section(&mut text, measured, effort.race_turns);
    races::nine_taps(&mut text, measured, effort.nine_turns);
    words(&mut text, effort.turns);
    if shared_scenes().is_none() {
        text.push_str(WITHOUT_SHARED);
    }

    for (set, cells) in measured.iter().zip(cells) {
        section(&mut text, set, cells);
    }
    text.push_str("## Bias\n\n");
    bias::section(&mut text, biases);
    text.push_str(ITSELF);
    text
}

/// What the tables hold.
fn words(text: &mut String, turns: u32) {
    let three = if turns == 3 { ", of three turns a quarter of that between the fastest and the slowest" } else { "" };
    let _ = writeln!(
        text,
        "## Techniques and encodings\n\n\
         Every named technique; `cascades` with every filter of depths (bilinear 2×2 is `cascades` itself), \
         and with depth over w; and every kind of moments in every format that the adapter has and no named technique, \
         focused and without mips. Contenders of one case and size were drawn turn by turn, {turns} times, forwards and backwards \
         in alternation, after one that is not timed. Summed-area tables and convolution maps are drawn below {LARGE} texels alone, the smallest and the largest maps by {} alone. \
         Medians over the cases of a set:\n\n\
         - *excess*: mean absolute error against the area truth above that of a perfect hard edge, %; negative where filtering beats it;\n\
         - *wrong*: pixels more than half off the centre truth, %; *leak*: those of them that are lit, further than 2 px from edges, %;\n\
         - *ms*: time of a frame (fit, casters, filter, receivers), median over turns, ± half the distance between the quartiles{three};\n\
         - *MiB*: memory of the maps, with everything that fills them.\n\n\
         **Bold**: on the Pareto front of that error and time, over all contenders and sizes of the set. A run whose picture has {:.0} % wrong \
         pixels or more counts as failed, and a failed run as worse than all others.\n",
        FEW.map(|name| format!("`{name}`")).join(", "),
        100.0 * WORST_WRONG
    );
}

/// A set's plots and table.
fn section(text: &mut String, set: &Measured, cells: &[Cell]) {
    let _ = writeln!(text, "### {}\n", set.set);
    for figure in &FIGURES {
        let [front, all] = [true, false].map(|front| plots::file(&set.set, figure, front));
        let _ = writeln!(text, "![{} and time, curves of the front]({front})\n\n[All curves]({all})\n", figure.name);
    }
    let headings = FIGURES.map(|figure| figure.name).join(" | ");
    let _ = writeln!(text, "| technique | size | {headings} | ms | MiB |\n|---|--:|--:|--:|--:|--:|--:|");
    for cell in cells {
        let figure = |place: usize| {
            let number = format!("{:.3}", cell.figures[place]);
            if cell.on_front[place] { format!("**{number}**") } else { number }
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {:.1} ± {:.1} | {:.1} |",
            cell.name,
            cell.size,
            figure(0),
            figure(1),
            figure(2),
            cell.ms,
            cell.spread_ms,
            cell.bytes as f64 / f64::from(1 << 20)
        );
    }
    text.push('\n');
    failures(text, set, cells);
}

/// Who failed, how often, and what they said.
fn failures(text: &mut String, set: &Measured, cells: &[Cell]) {
    for cell in cells.iter().filter(|cell| cell.failed > 0) {
        let of = |row: &&Row| row.technique == cell.name && row.size == cell.size && row.failed();
        let said: Vec<String> = (set.records.iter().map(|record| &record.row).filter(of))
            .map(|row| format!("{}: {}", row.case, row.left_out.join("; ")))
            .collect();
        let Cell { name, size, failed, cases, .. } = cell;
        let _ = writeln!(text, "- `{name}` {size} failed in {failed} of {cases} cases. {}", said.join(". "));
    }
    if cells.iter().any(|cell| cell.failed > 0) {
        text.push('\n');
    }
}
