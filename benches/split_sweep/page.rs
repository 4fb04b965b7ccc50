//! The page of what splits buy.

use std::fmt::Write as _;

use antumbra::lab::statistics::geometric_mean;
use antumbra::lab::subject::Knowledge;

use crate::Record;

/// What techniques are told, by the suffix of their names.
pub(crate) const KNOWN: [(&str, Knowledge); 3] =
    [("", Knowledge::Bounds), (" (points)", Knowledge::Points), (" (depths)", Knowledge::Depths)];

/// The yardstick.
const YARDSTICK: &str = "λ 0.5, by depth";

/// Yardsticks with fewer wrong pixels than this share leave nothing to gain: 48 pixels of 800 × 600.
const LEAST_WRONG: f64 = 1e-4;

/// Half a pixel of 800 × 600: stands for none where a ratio is taken.
const HALF_A_PIXEL: f64 = 1e-6;

/// Columns of the table of cases.
const SHOWN: [&str; 5] = [YARDSTICK, "λ 0.8, by depth", "cascades", "cascades (points)", "cascades (depths)"];

/// The yardstick of shares.
pub(crate) const EQUAL: &str = "4 maps, equal";

const SHARES: &str = "
## Shares of the texels

*Cascades* with other `share`s, and other numbers of maps, in 4 layers of `size`² texels unless they say otherwise. *÷ equal*: wrong pixels
over those of `Share::Equal` with 4 maps and the same knowledge, geometric mean; *÷ texels*: texels that are drawn, over that one's, mean;
*layers*: in use, mean.
";

const HEAD: &str = "# What splits buy

This page is written by the command below; every number on it comes from that run, but for *What planes leave on the table*.
";

const TABLE: &str = "
Four maps each, hardware 2×2 filter. Wrong pixels are those more than half off the centre truth; *÷ λ ½* is their number over that of
parallel splits with λ = ½, found by depth, without a warp (`pssm` with four maps), geometric mean; *worst* and *where*: the largest such
ratio; *maps*: how many there were in the mean. Without a suffix a technique knows the scene's bounds, its objects' bounds and the shadow
distance; *points*: a few hundred visible positions as well; *depths*: those and the range of the depth buffer. *Finest*: receivers are
looked up in the first map that holds them. *Cascades*: equal error, finest, least-error warp.
";

/// What a search by hand found, once; it is not repeated by every run.
const LEFT: &str = "
## What planes leave on the table

Measured once, on these pictures, cascades of 512 and 1024 texels; brute force in place of the search: wrong pixels over those of
the equal-error planes, geometric means, case files / built-in scenes.

| planes | bounds | points | depths |
|---|--:|--:|--:|
| least wrong pixels at 512, truth known | 0.83 / 0.82 | 0.86 / 0.88 | – |
| the same planes at 1024 | 0.84 / 0.85 | 0.92 / 0.97 | – |
| least error of the warped maps, each for its own slice | 1.02 / 1.02 | 0.99 / 1.02 | 1.03 / 1.01 |
| least texel of the map that receivers are found in, no warp | 0.99 / 0.99 | 0.95 / 1.09 | 0.98 / 1.04 |
| the same, as the warp leaves it | 1.00 / 1.01 | 0.94 / 0.97 | 0.97 / 0.97 |
| slices' sizes times a closed form of what a warp takes off | 1.08 / 1.05 | 1.01 / 1.06 | 1.03 / 1.01 |
| the same, samples counted where a map first holds them | 1.08 / 1.05 | 0.97 / 1.02 | 0.98 / 1.02 |
| all planes nearer by 5 % | 0.99 / 0.99 | 0.99 / 1.07 | 1.00 / 1.02 |

The warp alone moves the planes to no better ones. Together with where receivers are found it does, by 3 to 6 % where points are given, for
hundreds of fits a picture; what stands for both in a few flops gains on the case files and loses on the built-in scenes. Differences of a
hundredth are chance: planes nearer by 5 % change a picture by 2 % in the median, and changed one of them (`sparse-city/across`, points) by a factor
of two before commit `c40d306`: the second map was then warped for the samples between its planes, and coarse for those just behind them that
are found in it too. A warp chosen for all samples behind its first plane mends that picture, and is no answer either: 1.02 / 0.99 with
points, 1.04 / 0.98 with depths. One that may be 5 % worse for those, and no more, mends it and leaves the others what they are. This table
was measured before it.
";

pub(crate) fn page(meta: &[(&str, String)], records: &[Record], shared: &[Record]) -> String {
    let mut text = HEAD.to_owned();
    text.push('\n');
    for (name, value) in meta {
        let _ = writeln!(text, "- {name}: `{value}`");
    }
    text.push_str(TABLE);
    for (set, name) in [("shared", "case files"), ("built-in", "built-in scenes")] {
        techniques(&mut text, name, &records.iter().filter(|record| record.set == set).collect::<Vec<_>>());
    }
    text.push_str(SHARES);
    for (set, name) in [("shared", "case files"), ("built-in", "built-in scenes")] {
        shares(&mut text, name, &shared.iter().filter(|record| record.set == set).collect::<Vec<_>>());
    }
    text.push_str(LEFT);
    cases(&mut text, records);
    text
}

fn of<'a>(records: &[&'a Record], like: &Record, technique: &str) -> Option<&'a Record> {
    let same =
        |record: &&&Record| record.case == like.case && record.size == like.size && record.technique == technique;
    records.iter().find(same).copied()
}

/// A table of techniques over the pictures of a set.
fn techniques(text: &mut String, name: &str, records: &[&Record]) {
    let yardsticks: Vec<&&Record> =
        records.iter().filter(|record| record.technique == YARDSTICK && record.wrong >= LEAST_WRONG).collect();
    if yardsticks.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "\n| {name} ({}) | ÷ λ ½ | worst | where | above 1.10 | maps |\n|---|--:|--:|---|--:|--:|",
        yardsticks.len()
    );
    let mut names: Vec<&str> = Vec::new();
    for record in records {
        if !names.contains(&record.technique.as_str()) {
            names.push(&record.technique);
        }
    }
    for technique in names {
        let pairs: Vec<(&Record, f64)> = yardsticks
            .iter()
            .filter_map(|yardstick| {
                let record = of(records, yardstick, technique)?;
                Some((record, record.wrong.max(HALF_A_PIXEL) / yardstick.wrong))
            })
            .collect();
        let ratios: Vec<f64> = pairs.iter().map(|(_, ratio)| *ratio).collect();
        let Some((worst, ratio)) = pairs.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
        let maps = pairs.iter().map(|(record, _)| record.views as f64).sum::<f64>() / pairs.len() as f64;
        let above = ratios.iter().filter(|ratio| **ratio > 1.1).count();
        let _ = writeln!(
            text,
            "| {technique} | {:.3} | {ratio:.2} | {} {} | {above} | {maps:.1} |",
            geometric_mean(&ratios),
            worst.case,
            worst.size
        );
    }
}

/// A table of shares over the pictures of a set.
fn shares(text: &mut String, name: &str, records: &[&Record]) {
    let _ = writeln!(
        text,
        "\n| {name} | ÷ equal | worst | where | above 1.10 | ÷ texels | layers | maps |\n|---|--:|--:|---|--:|--:|--:|--:|"
    );
    let mut names: Vec<&str> = Vec::new();
    for record in records {
        if !names.contains(&record.technique.as_str()) {
            names.push(&record.technique);
        }
    }
    for technique in names {
        let suffix = if technique.ends_with(KNOWN[1].0) { KNOWN[1].0 } else { KNOWN[0].0 };
        let yardstick = format!("{EQUAL}{suffix}");
        let pairs: Vec<(&Record, &Record)> = records
            .iter()
            .filter(|record| record.technique == technique)
            .filter_map(|record| Some((*record, of(records, record, &yardstick)?)))
            .filter(|(_, equal)| equal.wrong >= LEAST_WRONG)
            .collect();
        let ratio = |(record, equal): &(&Record, &Record)| record.wrong.max(HALF_A_PIXEL) / equal.wrong;
        let Some(worst) = pairs.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b))) else { continue };
        let mean =
            |figure: &dyn Fn(&(&Record, &Record)) -> f64| pairs.iter().map(figure).sum::<f64>() / pairs.len() as f64;
        let ratios: Vec<f64> = pairs.iter().map(ratio).collect();
        let _ = writeln!(
            text,
            "| {technique} | {:.3} | {:.2} | {} {} | {} | {:.2} | {:.1} | {:.1} |",
            geometric_mean(&ratios),
            ratio(worst),
            worst.0.case,
            worst.0.size,
            ratios.iter().filter(|ratio| **ratio > 1.1).count(),
            mean(&|(record, equal)| record.texels as f64 / equal.texels.max(1) as f64),
            mean(&|(record, _)| f64::from(record.layers)),
            mean(&|(record, _)| record.views as f64),
        );
    }
}

/// Every picture of the techniques that matter.
fn cases(text: &mut String, records: &[Record]) {
    let _ = writeln!(text, "\n## Cases\n\nWrong pixels, %.\n\n| case | size | {} |", SHOWN.join(" | "));
    let _ = writeln!(text, "|---|--:|{}", "--:|".repeat(SHOWN.len()));
    let all: Vec<&Record> = records.iter().collect();
    for yardstick in all.iter().filter(|record| record.technique == YARDSTICK) {
        let cells = SHOWN.map(|technique| {
            of(&all, yardstick, technique).map_or("–".to_owned(), |record| format!("{:.3}", 100.0 * record.wrong))
        });
        let _ = writeln!(text, "| {} | {} | {} |", yardstick.case, yardstick.size, cells.join(" | "));
    }
}
