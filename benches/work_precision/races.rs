//! The sections of ratios: the library beside passes by hand, and four comparisons beside nine.

use std::fmt::Write as _;

use antumbra::lab::gpu::Race;

use crate::contenders::{LARGE, NINE_TAPS};
use crate::measure::{Measured, NineTaps, RACE_SIZE};
use crate::summary::median;

/// A ratio of a race.
type Ratio = fn(&Race) -> f64;

/// The columns of the table of races: heading, and ratio.
const RATIOS: [(&str, Ratio); 6] = [
    ("casters", |race| race.casters_ratio),
    ("shaded", |race| race.receivers_ratio),
    ("bare", |race| race.receivers_bare_ratio),
    ("bare, matrix at vertices", |race| race.receivers_vertex_ratio),
    ("whole, shaded", |race| race.whole_ratio),
    ("whole, bare", |race| race.whole_bare_ratio),
];

/// The library beside what is written by hand.
pub(crate) fn section(text: &mut String, measured: &[Measured], turns: u32) {
    let _ = writeln!(
        text,
        "## What the library adds to the least that can be done\n\n\
         Library / by hand, a map of {RACE_SIZE} texels, medians of {turns} ratios, each of neighbours in time. Casters: against a depth pass with \
         one matrix. Receivers (`fsm`, hardware 2×2, automatic bias, in two stages as `compare`, `mask` and `plug_in` draw them: \
         `antumbra_place` at vertices, `antumbra_lit` at fragments) against one matrix, one comparison sample and a constant bias:\n\n\
         - *shaded*: both sides shade what arrives with Lambert's cosine, for which an engine has the normal at hand;\n\
         - *bare*: neither side shades, and by hand nobody reads a normal;\n\
         - *bare, matrix at vertices*: as bare, with the matrix by hand moved to the vertex stage as well;\n\
         - *whole*: the library in one stage, `antumbra_visibility` at fragments, which smooth normals on large triangles need.\n"
    );
    let headings = RATIOS.map(|(heading, _)| heading).join(" | ");
    let _ = writeln!(text, "| set | case | {headings} |\n|---|---|{}", "--:|".repeat(RATIOS.len()));
    for set in measured {
        for (case, race) in &set.races {
            let cells = RATIOS.map(|(_, ratio)| format!("{:.3}", ratio(race))).join(" | ");
            let _ = writeln!(text, "| {} | {case} | {cells} |", set.set);
        }
    }
    let all = |ratio: Ratio| measured.iter().flat_map(|set| &set.races).map(move |(_, race)| ratio(race));
    let medians = RATIOS.map(|(_, ratio)| format!("**{:.3}**", median(all(ratio)))).join(" | ");
    let _ = writeln!(text, "| all | median | {medians} |");
    let ranges = RATIOS.map(|(_, ratio)| range(all(ratio)));
    let _ = writeln!(text, "| all | range | {} |\n", ranges.join(" | "));
}

/// Turns, and those of large maps where these are others.
fn counts([turns, large]: [u32; 2]) -> String {
    if large == turns { turns.to_string() } else { format!("{turns} (from {LARGE} texels on {large})") }
}

/// The receivers of `smra-plus` beside receivers of nine comparisons.
pub(crate) fn nine_taps(text: &mut String, measured: &[Measured], turns: [u32; 2]) {
    let _ = writeln!(
        text,
        "## Receivers beside nine comparisons\n\n\
         Filter and receivers of `smra-plus` over receivers with a box of nine bilinear comparisons (`Pcf::Box5x5`): *maps*, in the same four \
         maps (`{}`); *one*, in one focused map (`{}`), whose receivers need not find their map. The three are \
         drawn in turns, apart from all others: medians of {} ratios, each of neighbours in time; below 1 `smra-plus` is cheaper.\n",
        NINE_TAPS[0],
        NINE_TAPS[1],
        counts(turns)
    );
    let mut sizes: Vec<u32> = measured.iter().flat_map(|set| &set.nine_taps).map(|ratio| ratio.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let headings: Vec<String> = sizes.iter().map(|size| format!("{size}: maps | one")).collect();
    let _ = writeln!(text, "| set | case | {} |\n|---|---|{}", headings.join(" | "), "--:|--:|".repeat(sizes.len()));
    let number = |ratio: Option<&NineTaps>, place: usize| {
        ratio.map_or_else(|| "NaN".to_owned(), |ratio| format!("{:.3}", ratio.ratios[place]))
    };
    for set in measured {
        let mut cases: Vec<&str> = set.nine_taps.iter().map(|ratio| ratio.case.as_str()).collect();
        cases.dedup();
        for case in cases {
            let cells = sizes.iter().map(|size| {
                let found = set.nine_taps.iter().find(|ratio| ratio.case == case && ratio.size == *size);
                format!("{} | {}", number(found, 0), number(found, 1))
            });
            let _ = writeln!(text, "| {} | {case} | {} |", set.set, cells.collect::<Vec<_>>().join(" | "));
        }
    }
    let all = |place: usize| measured.iter().flat_map(|set| &set.nine_taps).map(move |ratio| ratio.ratios[place]);
    let below = |place: usize| all(place).filter(|ratio| *ratio < 1.0).count();
    let _ = writeln!(
        text,
        "\nAll pictures: in the same maps {:.3} in the median, {}, below 1 in {} of {}; beside one map {:.3}, {}, below 1 in {}.\n",
        median(all(0)),
        range(all(0)),
        below(0),
        all(0).count(),
        median(all(1)),
        range(all(1)),
        below(1)
    );
}

fn range(values: impl Iterator<Item = f64> + Clone) -> String {
    let (least, most) = (values.clone().reduce(f64::min), values.reduce(f64::max));
    format!("{:.3} to {:.3}", least.unwrap_or(f64::NAN), most.unwrap_or(f64::NAN))
}
