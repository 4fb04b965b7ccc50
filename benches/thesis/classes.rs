//! The thesis's two tables, beside what was measured.

use std::fmt::Write as _;

use antumbra::techniques;

use crate::artefacts::{Artefacts, Jumps, largest_jumps};
use crate::duel::Set;
use crate::measure::{Record, Results, Times};
use crate::programme::{PLUS, PSSM, SHOWN, SIX, SMRA, SSM, TSM, VSM, six};

/// Table 1 as printed, by technique: perspective aliasing, projection aliasing, texture resolution, self-shadowing,
/// continuity, binary edges. SMRA is not in it.
const TABLE_ONE: [(&str, [&str; 6]); 4] = [
    (SSM, ["✗", "✗", "✗", "✗", "–", "✗"]),
    (TSM, ["✓", "✗", "✗", "✓", "✓", "✗"]),
    (PSSM, ["✗", "✗", "✓", "✓", "✗", "✗"]),
    (VSM, ["✗", "✗", "✗", "✓", "✓", "✓"]),
];

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

/// A line of Table 1: a number of a class for each of the six.
struct Line {
    class: usize,
    /// Name of the class, in its first line alone.
    name: &'static str,
    number: String,
    values: [f64; 6],
    decimals: usize,
}

/// Every line of it.
fn lines(set: Set) -> Result<Vec<Line>, String> {
    let sizes = set.sizes();
    let (Some(&small), Some(&large)) = (sizes.first(), sizes.last()) else { return Ok(Vec::new()) };
    let summed = |name: &str, figure: fn(&Artefacts) -> f64| -> f64 {
        set.of(name, Some(small)).filter_map(|record| record.artefacts).map(|artefacts| figure(&artefacts)).sum()
    };
    let ratio =
        |over: fn(&Artefacts) -> f64, of: fn(&Artefacts) -> f64| SIX.map(|name| summed(name, over) / summed(name, of));
    let mean = |size, figure: fn(&Record) -> f64| SIX.map(|name| set.mean(name, Some(size), figure));
    let percent = |values: [f64; 6]| values.map(|value| 100.0 * value);
    let mut jumps = Vec::new();
    for (_, remix) in six() {
        jumps.push(largest_jumps(&remix, false)?);
    }
    let jump = |figure: fn(&Jumps) -> f64| -> [f64; 6] { std::array::from_fn(|index| 100.0 * figure(&jumps[index])) };
    let line =
        |class, name, number: &str, values, decimals| Line { class, name, number: number.to_owned(), values, decimals };
    let root = ratio(|a| a.edges[2], |a| a.edges[0]).map(f64::sqrt);
    Ok(vec![
        line(
            0,
            "perspective aliasing",
            "pixels per texel, 19 in 20 have at most",
            ratio(|a| a.perspective[1], |_| 1.0),
            2,
        ),
        line(0, "", "the same, half have at most", ratio(|a| a.perspective[0], |_| 1.0), 2),
        line(
            1,
            "projection aliasing",
            "mean error where the light grazes, %",
            percent(ratio(|a| a.grazed[0], |a| a.grazed[1])),
            2,
        ),
        line(2, "texture resolution", "wrong pixels, %", percent(mean(small, |r| r.wrong)), 2),
        line(2, "", &format!("the same at {large}, %"), percent(mean(large, |r| r.wrong)), 2),
        line(
            2,
            "",
            "displacement of edges, pixels",
            mean(small, |r| if r.edge_px.is_finite() { r.edge_px } else { 0.0 }),
            2,
        ),
        line(3, "self-shadowing", "false shadow away from edges, %", percent(mean(small, |r| r.acne)), 4),
        line(4, "continuity", "largest jump of a texel's area, %", jump(|jumps| jumps.any), 1),
        line(4, "", "the same, where the same map serves", jump(|jumps| jumps.same_map), 1),
        line(
            5,
            "binary edges",
            "edge pixels that are not grey, %",
            percent(ratio(|a| a.edges[0] - a.edges[1], |a| a.edges[0])),
            2,
        ),
        line(5, "", "root mean square error of edge pixels", root, 3),
    ])
}

/// Classes whose first number is compared with the standard map's: the others have no such yardstick in the thesis.
const COMPARED: [usize; 4] = [0, 1, 2, 3];

/// What a mark of ✗ should leave, as a share of the standard map's number: less is a technique that does tackle it.
const LEFT: f64 = 0.5;

/// A number for each class of artefact with the printed mark, and which marks the numbers contradict.
pub(crate) fn table_one(text: &mut String, set: Set) -> Result<(), String> {
    let _ = writeln!(text, "\n| class | number | {} |\n|---|---|{}", SIX.join(" | "), "--:|".repeat(SIX.len()));
    let mut contradicted = Vec::new();
    for Line { class, name, number, values, decimals } in lines(set)? {
        let mut cells = Vec::new();
        for (technique, value) in SIX.into_iter().zip(values) {
            let mark = if name.is_empty() { "" } else { mark(technique, class) };
            cells.push(format!("{value:.decimals$} {mark}").trim_end().to_owned());
            let left = value / values[0];
            let wrong = match mark {
                "✓" => left >= 1.0,
                "✗" => left < LEFT,
                _ => false,
            };
            if wrong && COMPARED.contains(&class) {
                contradicted.push(format!("{technique} {mark} for {name} ({left:.2} times {SSM}'s number)"));
            }
        }
        let _ = writeln!(text, "| {name} | {number} | {} |", cells.join(" | "));
    }
    let list = if contradicted.is_empty() { "none".to_owned() } else { contradicted.join("; ") };
    let _ = writeln!(
        text,
        "\nMarks of the first four classes that the numbers contradict (✓ without less than {SSM}, or ✗ with less than {LEFT} times it): {list}."
    );
    Ok(())
}

/// The printed mark of a technique.
fn mark(technique: &str, class: usize) -> &'static str {
    TABLE_ONE.iter().find(|(name, _)| *name == technique).map_or("", |(_, marks)| marks[class])
}

/// What is known to be wrong in the table, and how this differs from the thesis.
pub(crate) fn about_table_one(text: &mut String, set: Set) -> Result<(), String> {
    let Some(small) = set.sizes().first().copied() else { return Ok(()) };
    let high = |name: &str| set.mean(name, Some(small), |r| r.artefacts.map_or(f64::NAN, |a| a.perspective[1]));
    let (standard, split) = (high(SSM), high(PSSM));
    let [greedy, steady] = [true, false].map(|greedy| largest_jumps(&techniques::pssm(), greedy));
    let (greedy, steady) = (greedy?.any, steady?.any);
    let _ = writeln!(
        text,
        "\nErratum TH-16: the table marks PSSM ✗ for perspective aliasing. Here it {} the texels of the 19 in 20 from {standard:.1} to {split:.1} pixels. Its ✗ for \
         continuity is that of maps fitted to the objects in the picture, as they were published: these jump by {:.0} % while a building enters, and by \
         {:.1} % fitted to the scene as all are here. One lookup of this crate weighs four texels where the thesis calls hard shadows binary, so that its {SSM}, {TSM} \
         and {PSSM} have grey edge pixels where texels are coarse.",
        if split < standard { "reduces" } else { "does not reduce" },
        100.0 * greedy,
        100.0 * steady
    );
    Ok(())
}

/// Times over the standard map's, beside the printed ones, and pass by pass.
pub(crate) fn table_two(text: &mut String, results: &Results) {
    let _ = writeln!(
        text,
        "\n| scene | size | technique | fit, ms | casters, ms | filter, ms | receivers, ms | total, ms | ÷ SSM | printed |\n|---|--:|---|--:|--:|--:|--:|--:|--:|--:|"
    );
    for (scene, size, name, times) in &results.timed {
        let standard = timed(results, scene, *size, SSM);
        let printed = printed(scene, *size, name).map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"));
        let _ = writeln!(
            text,
            "| {scene} | {size} | {name} | {:.3} | {:.1} | {:.1} | {:.1} | {:.1} | {:.2} | {printed} |",
            times.fit,
            times.casters,
            times.filter,
            times.receivers,
            times.total(),
            times.total() / standard.total()
        );
    }
    slower_than_printed(text, results);
}

fn timed(results: &Results, scene: &str, size: u32, name: &str) -> Times {
    let found = results.timed.iter().find(|(a, b, c, _)| *a == scene && *b == size && *c == name);
    found.map_or_else(Times::default, |(.., times)| *times)
}

/// Where SMRA costs more than the thesis says, and which pass does.
fn slower_than_printed(text: &mut String, results: &Results) {
    let (mut cells, mut above) = (0, Vec::new());
    for (scene, size, _, times) in results.timed.iter().filter(|(_, _, name, _)| *name == SMRA) {
        let Some(printed) = printed(scene, *size, SMRA) else { continue };
        let standard = timed(results, scene, *size, SSM);
        let ratio = times.total() / standard.total();
        cells += 1;
        if ratio > printed {
            let added = times.passes().into_iter().zip(standard.passes()).map(|((name, a), (_, b))| (name, a - b));
            let (pass, most) = added.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(("fit", 0.0));
            let share = 100.0 * most / (times.total() - standard.total());
            above.push(format!(
                "{scene} at {size} {ratio:.2} against {printed:.2} ({pass}: {share:.0} % of what is added)"
            ));
        }
    }
    let list = if above.is_empty() { String::new() } else { format!(": {}", above.join("; ")) };
    let scenes = SHOWN.map(|(scene, case)| format!("{scene}/{case}"));
    let _ = writeln!(
        text,
        "\nViews: {}. SMRA over SSM is above the printed ratio in {} of {cells} cells{list}. The printed ratios are of whole frames, which hold work that all techniques have \
         in common; these are of fit, casters, filter and receivers alone, which moves every ratio away from 1. Erratum TH-15: the printed TreeLine has SMRA faster \
         than PSSM, which is a part of it; its ratios for PSSM (2.85 to 3.00) are not reliable. {}",
        scenes.join(", "),
        above.len(),
        order(results)
    );
}

/// Whether SMRA is faster than parallel splits anywhere here.
fn order(results: &Results) -> String {
    let cells = results.timed.iter().filter(|(_, _, name, _)| *name == SMRA);
    let (mut count, mut faster) = (0, 0);
    for (scene, size, _, times) in cells {
        count += 1;
        faster += usize::from(times.total() < timed(results, scene, *size, PSSM).total());
    }
    format!("Here SMRA is faster than PSSM in {faster} of {count} cells.")
}

/// SMRA plus beside SMRA, where both were timed.
pub(crate) fn plus_and_smra(text: &mut String, results: &Results) {
    let ratios: Vec<f64> = results
        .timed
        .iter()
        .filter(|(_, _, name, _)| *name == PLUS)
        .map(|(scene, size, _, times)| times.total() / timed(results, scene, *size, SMRA).total())
        .collect();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = ratios.iter().copied().fold(0.0, f64::max);
    let _ = writeln!(text, "\nSMRA plus takes {least:.2} to {most:.2} times SMRA's time.");
}
