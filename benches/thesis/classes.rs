//! The thesis's table of artefacts, beside what was measured.

use std::fmt::Write as _;

use antumbra::lab::entering::{FRAMES, Jumps, SIDE, largest_jumps};
use antumbra::lab::statistics;
use antumbra::{Remix, techniques};

use crate::artefacts::Artefacts;
use crate::duel::{Set, holds};
use crate::measure::Record;
use crate::programme::{PLUS, PSSM, SIX, SMRA, SSM, TSM, VSM, six};

/// Table 1 as printed, by technique: perspective aliasing, projection aliasing, texture resolution, self-shadowing,
/// continuity, binary edges. SMRA is not in it.
const TABLE_ONE: [(&str, [&str; 6]); 4] = [
    (SSM, ["✗", "✗", "✗", "✗", "–", "✗"]),
    (TSM, ["✓", "✗", "✗", "✓", "✓", "✗"]),
    (PSSM, ["✗", "✗", "✓", "✓", "✗", "✗"]),
    (VSM, ["✗", "✗", "✗", "✓", "✓", "✓"]),
];

/// A line of Table 1: a number of a class for each of the six.
struct Line {
    class: usize,
    name: &'static str,
    number: String,
    values: [f64; 6],
    decimals: usize,
}

impl Line {
    /// Its numbers as they are printed.
    fn cells(&self) -> Vec<String> {
        let Self { values, decimals, .. } = self;
        values.iter().map(|value| format!("{value:.decimals$}")).collect()
    }
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
        jumps.push(largest_jumps(&remix, false).map_err(|error| error.to_string())?);
    }
    let jump = |figure: fn(&Jumps) -> f64| -> [f64; 6] { std::array::from_fn(|index| 100.0 * figure(&jumps[index])) };
    let (displaced, unseen) = displacements(set, small);
    let line =
        |class, name, number: &str, values, decimals| Line { class, name, number: number.to_owned(), values, decimals };
    let root = ratio(|a| a.edges[2], |a| a.edges[0]).map(f64::sqrt);
    let mut lines = vec![
        line(
            0,
            "perspective aliasing",
            "pixels per texel, 19 in 20 have at most",
            ratio(|a| a.perspective[1], |_| 1.0),
            2,
        ),
        line(0, "perspective aliasing", "the same, half have at most", ratio(|a| a.perspective[0], |_| 1.0), 2),
        line(
            1,
            "projection aliasing",
            "mean error where the light grazes, %",
            percent(ratio(|a| a.grazed[0], |a| a.grazed[1])),
            2,
        ),
        line(2, "texture resolution", "wrong pixels, %", percent(mean(small, |r| r.wrong)), 2),
        line(2, "texture resolution", &format!("the same at {large}, %"), percent(mean(large, |r| r.wrong)), 2),
        line(2, "texture resolution", &format!("displacement of edges, pixels{unseen}"), displaced, 2),
        line(3, "self-shadowing", "false shadow away from edges, %", percent(mean(small, |r| r.acne)), 4),
        line(4, "continuity", "largest jump of a texel's area, %", jump(|jumps| jumps.any), 1),
        line(4, "continuity", "the same, where the same map serves", jump(|jumps| jumps.same_map), 1),
        line(
            5,
            "binary edges",
            "edge pixels that are not grey, %",
            percent(ratio(|a| a.edges[0] - a.edges[1], |a| a.edges[0])),
            2,
        ),
        line(5, "binary edges", "root mean square error of edge pixels", root, 3),
    ];
    // A line that repeats the one above it says nothing.
    lines.dedup_by(|line, above| line.cells() == above.cells());
    Ok(lines)
}

/// Mean displacement of edges where there are any to follow, and how many pictures have none.
fn displacements(set: Set, size: u32) -> ([f64; 6], String) {
    let all = |name: &'static str| set.of(name, Some(size)).map(|record| record.edge_px);
    let means = SIX.map(|name| statistics::mean(&all(name).flatten().collect::<Vec<_>>()));
    let unseen: usize = SIX.iter().map(|name| all(name).filter(Option::is_none).count()).sum();
    (means, if unseen == 0 { String::new() } else { format!(" ({unseen} pictures of all six have none)") })
}

/// Classes whose first number is compared with the standard map's. Continuity is not: that map does not have the
/// artefact.
const COMPARED: [usize; 5] = [0, 1, 2, 3, 5];

/// What a mark of ✓ leaves at most, and one of ✗ at least, as a share of the standard map's number.
const LEFT: f64 = 0.5;

/// What is aimed at: the largest jump over that of maps fitted to the objects in the picture.
const SMALL_JUMP: f64 = 0.1;

/// A number for each class of artefact with the printed mark, and which marks the numbers contradict.
pub(crate) fn table_one(text: &mut String, set: Set) -> Result<(), String> {
    let _ = writeln!(text, "\n| class | number | {} |\n|---|---|{}", SIX.join(" | "), "--:|".repeat(SIX.len()));
    let mut contradicted = Vec::new();
    let mut above = None;
    for line in lines(set)? {
        let Line { class, name, ref number, values, .. } = line;
        // Marks stand beside the first number of a class.
        let first = above.replace(class) != Some(class);
        let mut cells = Vec::new();
        for ((technique, value), cell) in SIX.into_iter().zip(values).zip(line.cells()) {
            let mark = if first { mark(technique, class) } else { "" };
            cells.push(format!("{cell} {mark}").trim_end().to_owned());
            let left = value / values[0];
            let wrong = (mark == "✓" && left > LEFT) || (mark == "✗" && left < LEFT);
            if wrong && COMPARED.contains(&class) {
                contradicted.push(format!("{technique} {mark} for {name} ({left:.2} times {SSM}'s number)"));
            }
        }
        let _ = writeln!(text, "| {name} | {number} | {} |", cells.join(" | "));
    }
    let list = if contradicted.is_empty() { "none".to_owned() } else { contradicted.join("; ") };
    let _ = writeln!(
        text,
        "\nMarks that the first numbers of their classes contradict (✓ with more than {LEFT} times {SSM}'s number, ✗ with less; continuity apart, of which {SSM} has \
         nothing to compare with): {list}."
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
    let _ = writeln!(
        text,
        "\nErratum TH-16: the table marks PSSM ✗ for perspective aliasing. Here it {} the texels of the 19 in 20 from {standard:.1} to {split:.1} pixels. One lookup of \
         this crate weighs four texels where the thesis calls hard shadows binary, so that its {SSM}, {TSM} and {PSSM} have grey edge pixels where texels are coarse.",
        if split < standard { "reduces" } else { "does not reduce" }
    );
    continuity(text)
}

/// Jumps beside those of parallel splits that are fitted to the objects in the picture.
fn continuity(text: &mut String) -> Result<(), String> {
    let jumps = |remix: &Remix, greedy| largest_jumps(remix, greedy).map_err(|error| error.to_string());
    let greedy = jumps(&techniques::pssm(), true)?;
    let [pssm, smra, plus] = [techniques::pssm(), techniques::smra(), techniques::smra_plus()];
    let steady = [jumps(&pssm, false)?, jumps(&smra, false)?, jumps(&plus, false)?];
    let percent = |jumps: &Jumps| 100.0 * jumps.any;
    let ratio = |jumps: &Jumps| jumps.any / greedy.any;
    let lost = |jumps: &[Jumps]| jumps.iter().map(|jumps| jumps.gained_or_lost).sum::<usize>();
    let _ = writeln!(
        text,
        "\nPSSM's ✗ for continuity is that of maps fitted to the objects in the picture, as they were published: in the same {FRAMES} frames of that scene, with maps of {SIDE} × {SIDE} texels, these jump \
         by {:.1} %. Fitted to the scene, as all are here, PSSM jumps by {:.1} %, {SMRA} by {:.1} %, {PLUS} by {:.1} %: {:.3}, {:.3} and {:.3} times that. At most {SMALL_JUMP} \
         times: for {SMRA} {}, for {PLUS} {}. Places that gain or lose their map from one frame to the next: {} under the three, {} under the maps fitted to objects.",
        percent(&greedy),
        percent(&steady[0]),
        percent(&steady[1]),
        percent(&steady[2]),
        ratio(&steady[0]),
        ratio(&steady[1]),
        ratio(&steady[2]),
        holds(ratio(&steady[1]) <= SMALL_JUMP && steady[1].gained_or_lost == 0),
        holds(ratio(&steady[2]) <= SMALL_JUMP && steady[2].gained_or_lost == 0),
        lost(&steady),
        greedy.gained_or_lost
    );
    Ok(())
}
