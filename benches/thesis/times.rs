//! The thesis's table of times, beside what was measured.

use std::fmt::Write as _;

use antumbra::lab::subject::SEEN_GRID;

use crate::duel::Set;
use crate::measure::Times;
use crate::programme::{PLUS, PSSM, SHOWN, SIX, SMRA, SSM};

/// Table 2 as printed: frames per second of SSM, TSM, PSSM, VSM, SMRA.
const TABLE_TWO: [(&str, u32, [f64; 5]); 6] = [
    ("treeline", 512, [78.0, 56.0, 27.0, 77.0, 40.0]),
    ("treeline", 1024, [74.0, 54.0, 26.0, 74.0, 38.0]),
    ("treeline", 2048, [72.0, 52.0, 24.0, 68.0, 36.0]),
    ("sparse-city", 512, [102.0, 88.0, 85.0, 98.0, 79.0]),
    ("sparse-city", 1024, [98.0, 84.0, 78.0, 96.0, 64.0]),
    ("sparse-city", 2048, [97.0, 70.0, 63.0, 88.0, 49.0]),
];

/// Printed frame time over the standard map's; none for SMRA plus.
fn printed(scene: &str, size: u32, name: &str) -> Option<f64> {
    let (_, _, fps) = TABLE_TWO.iter().find(|(known, side, _)| *known == scene && *side == size)?;
    let at = SIX[..fps.len()].iter().position(|known| *known == name)?;
    Some(fps[0] / fps[at])
}

/// A picture that was timed: scene, size of maps, technique.
type Cell<'a> = (&'a str, u32, &'static str, Times);

/// The six where the thesis has its pictures.
fn cells(set: Set) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (scene, case) in SHOWN {
        for size in set.sizes() {
            for name in SIX {
                let found = set.of(name, Some(size)).find(|record| record.scene == scene && record.case == case);
                cells.extend(found.and_then(|record| Some((scene, size, name, record.times?))));
            }
        }
    }
    cells
}

/// Another technique in the same place.
fn beside(cells: &[Cell], (scene, size, ..): &Cell, name: &str) -> Option<Times> {
    cells.iter().find(|(a, b, c, _)| a == scene && b == size && *c == name).map(|(.., times)| *times)
}

/// Times over the standard map's, beside the printed ones, and pass by pass.
pub(crate) fn table_two(text: &mut String, set: Set) {
    let cells = cells(set);
    let turns: Vec<String> = set
        .sizes()
        .into_iter()
        .filter_map(|size| cells.iter().find(|cell| cell.1 == size))
        .map(|(_, size, _, times)| format!("{} at {size}", times.turns))
        .collect();
    let _ = writeln!(
        text,
        "\nMedians of turns ({}), each of which draws every technique that this page has at that size, forwards and backwards in alternation, after one that is not timed. Casters: all \
         maps; receivers: one lookup a pixel, without shading; total: median of the turns' sums, ± half the distance between their quartiles. Fits know every object's bounds, and what is \
         seen at {} × {} points of the picture, which takes longer than the scene's bounds alone, as `cargo bench --bench fit` has them.",
        turns.join(", "),
        SEEN_GRID.x,
        SEEN_GRID.y
    );
    let _ = writeln!(
        text,
        "\n| scene | size | technique | fit, ms | casters, ms | filter, ms | receivers, ms | total, ms | ÷ SSM | printed |\n|---|--:|---|--:|--:|--:|--:|--:|--:|--:|"
    );
    for cell in &cells {
        let (scene, size, name, times) = cell;
        let standard = beside(&cells, cell, SSM).map_or(f64::NAN, |standard| standard.total);
        let printed = printed(scene, *size, name).map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"));
        let _ = writeln!(
            text,
            "| {scene} | {size} | {name} | {:.3} | {:.1} | {:.1} | {:.1} | {:.1} ± {:.1} | {:.2} | {printed} |",
            times.fit,
            times.casters,
            times.filter,
            times.receivers,
            times.total,
            times.spread,
            times.total / standard
        );
    }
    slower_than_printed(text, &cells);
    plus_and_smra(text, &cells);
}

/// Where SMRA costs more than the thesis says, and which pass does.
fn slower_than_printed(text: &mut String, cells: &[Cell]) {
    let (mut count, mut above) = (0, Vec::new());
    for cell in cells.iter().filter(|(_, _, name, _)| *name == SMRA) {
        let (scene, size, _, times) = cell;
        let (Some(printed), Some(standard)) = (printed(scene, *size, SMRA), beside(cells, cell, SSM)) else { continue };
        let ratio = times.total / standard.total;
        count += 1;
        if ratio > printed {
            let added = times.passes().into_iter().zip(standard.passes()).map(|((name, a), (_, b))| (name, a - b));
            let (pass, most) = added.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(("fit", 0.0));
            let share = 100.0 * most / (times.total - standard.total);
            above.push(format!(
                "{scene} at {size} {ratio:.2} against {printed:.2} ({pass}: {share:.0} % of what is added)"
            ));
        }
    }
    let list = if above.is_empty() { String::new() } else { format!(": {}", above.join("; ")) };
    let scenes = SHOWN.map(|(scene, case)| format!("{scene}/{case}"));
    let _ = writeln!(
        text,
        "\nViews: {}. SMRA over SSM is above the printed ratio in {} of {count} cells{list}. The printed ratios are of whole frames, which hold work that all techniques have \
         in common; these are of fit, casters, filter and receivers alone, which moves every ratio away from 1. Erratum TH-15: the printed TreeLine has SMRA faster \
         than PSSM, which is a part of it; its ratios for PSSM (2.85 to 3.00) are not reliable. {}",
        scenes.join(", "),
        above.len(),
        order(cells)
    );
}

/// Whether SMRA is faster than parallel splits anywhere here.
fn order(cells: &[Cell]) -> String {
    let ratios = ratios(cells, SMRA, PSSM);
    let faster = ratios.iter().filter(|ratio| **ratio < 1.0).count();
    format!("Here SMRA is faster than PSSM in {faster} of {} cells.", ratios.len())
}

/// Total times of a technique over another's, where both were timed.
fn ratios(cells: &[Cell], name: &str, other: &str) -> Vec<f64> {
    let these = cells.iter().filter(|cell| cell.2 == name);
    these.filter_map(|cell| Some(cell.3.total / beside(cells, cell, other)?.total)).collect()
}

/// SMRA plus beside SMRA.
fn plus_and_smra(text: &mut String, cells: &[Cell]) {
    let ratios = ratios(cells, PLUS, SMRA);
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = ratios.iter().copied().fold(0.0, f64::max);
    let _ = writeln!(text, "\nSMRA plus takes {least:.2} to {most:.2} times SMRA's time.");
}
