//! The page: every number and every sentence about numbers is made from the sweep.

use std::fmt::Write as _;

use antumbra::lab::statistics::{geometric_mean, mean};

use crate::cells::{Cell, Cells, LEAST_WRONG};
use crate::record::{Record, Sweep};
use crate::words::{self, NOTICEABLE};

/// Sets of cases, and how they are called on the page.
pub(crate) const SETS: [(&str, &str); 3] =
    [("shared", "case files"), ("tour", "tours"), ("built-in", "built-in scenes")];

/// Rows of the table of techniques: key in the sweep, and name on the page.
const TECHNIQUES: [(&str, &str); 11] = [
    ("fsm", "fsm"),
    ("psm unguarded", "psm, as printed"),
    ("psm", "psm, guarded"),
    ("tsm unguarded", "tsm, as printed"),
    ("tsm", "tsm, guarded"),
    ("lispsm unguarded", "lispsm, as printed"),
    ("lispsm", "lispsm, guarded"),
    ("minimax unguarded", "minimax, as printed"),
    ("minimax", "minimax, guarded"),
    ("least-error", "least-error"),
    (BEST, "best of the sweep"),
];
/// Stands for the best strength of the sweep among techniques.
const BEST: &str = "best";
/// Techniques of the table of cases.
const IN_CASES: [&str; 6] = ["fsm", "psm", "tsm", "lispsm", "minimax", "least-error"];
/// Size of map whose acne and leaks are told, texels.
const BIAS_SIZE: u32 = 2048;
/// What counts as close to the best strength.
const CLOSE: f64 = 0.1;
/// Rows of the tables of what is predicted worst, and of what is chosen worst.
const WORST: [usize; 2] = [10, 5];

pub(crate) fn page(sweep: &Sweep, cells: &Cells) -> String {
    let mut text = String::from(
        "# What warps buy\n\nThis page is written by the command below; every number on it comes from that run, and so does every \
         sentence that a number decides.\n\n",
    );
    for (name, value) in &sweep.meta {
        let _ = writeln!(text, "- {name}: `{value}`");
    }
    swept(&mut text, sweep, cells);
    text.push_str(PICTURES);
    // Techniques.
    text.push_str(TECHNIQUES_TEXT);
    for (set, name) in SETS {
        techniques(&mut text, set, name, cells);
    }
    let _ = writeln!(text, "## What each warp buys\n\n{PURCHASES}");
    for name in ["psm", "tsm", "lispsm", "minimax"] {
        let _ = writeln!(text, "{}", words::purchase(cells, name));
    }
    let _ = writeln!(text, "{}\n", words::purchase_of_own(cells, "least-error"));
    // Prediction.
    let _ = writeln!(text, "## Predicted and measured\n\n{PREDICTION}\n\n{}\n", words::agreement(cells));
    text.push_str("![predicted and measured error](warps-predicted.svg)\n\n");
    worst(&mut text, cells);
    // Cases.
    text.push_str(CASES);
    cases(&mut text, cells);
    text.push_str(BIAS);
    text
}

/// What was swept.
fn swept(text: &mut String, sweep: &Sweep, cells: &Cells) {
    let count = |set: &str| {
        let mut names: Vec<_> = sweep
            .records
            .iter()
            .filter(|record| record.set == set)
            .map(|record| (&record.scene, &record.case))
            .collect();
        names.dedup();
        names.len()
    };
    let sets: Vec<String> = SETS
        .into_iter()
        .filter(|(set, _)| count(set) > 0)
        .map(|(set, name)| format!("{} views in {name}", count(set)))
        .collect();
    let mut sizes: Vec<u32> = sweep.records.iter().map(|record| record.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let sizes: Vec<String> = sizes.iter().map(ToString::to_string).collect();
    let _ = writeln!(
        text,
        "\nSwept: {}; maps of {} texels a side; strengths κλ {} along the view, and the named techniques. {} pictures against ray-traced \
         truth, {} pairs of case and size. Left out of every mean: {} pairs of which the focused map gets less than {} % of the pixels \
         wrong, and {} with a failed run.\n",
        sets.join(", "),
        sizes.join(", "),
        crate::measure::STRENGTHS.map(|strength| strength.to_string()).join(", "),
        sweep.records.len(),
        cells.all.len() + cells.flawless + cells.failed,
        cells.flawless,
        100.0 * LEAST_WRONG,
        cells.failed
    );
}

/// The table of techniques over a set.
fn techniques(text: &mut String, set: &str, name: &str, cells: &Cells) {
    let cells: Vec<&Cell> = cells.of_set(set).collect();
    if cells.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "| {name} ({}) | ÷ fsm | worst | where | within {:.0} % | regret | above {:.2} | acne | leak |\n\
         |---|--:|--:|---|--:|--:|--:|--:|--:|",
        cells.len(),
        100.0 * CLOSE,
        1.0 + NOTICEABLE
    );
    for (key, called) in TECHNIQUES {
        let pictures: Vec<(&Cell, &Record)> = cells.iter().map(|cell| (*cell, cell.named(key))).collect();
        let ratios: Vec<f64> = pictures.iter().map(|(cell, record)| cell.of_fsm(record)).collect();
        let regrets: Vec<f64> = pictures.iter().map(|(cell, record)| cell.regret(record)).collect();
        let worst = (0..ratios.len()).fold(0, |worst, index| if ratios[index] > ratios[worst] { index } else { worst });
        let close = regrets.iter().filter(|regret| **regret <= CLOSE).count();
        let above = ratios.iter().filter(|ratio| **ratio > 1.0 + NOTICEABLE).count();
        let most = |share: fn(&Record) -> f64| {
            let shares = pictures.iter().filter(|(cell, _)| cell.size == BIAS_SIZE).map(|(_, record)| share(record));
            shares.reduce(f64::max).map_or_else(|| "–".to_owned(), |most| format!("{:.4}", 100.0 * most))
        };
        let _ = writeln!(
            text,
            "| {called} | {:.3} | {:.2} | {} {} | {:.0} % | {:+.1} % | {above} | {} | {} |",
            geometric_mean(&ratios),
            ratios[worst],
            cells[worst].case,
            cells[worst].size,
            100.0 * close as f64 / cells.len() as f64,
            100.0 * mean(&regrets),
            most(|record| record.acne),
            most(|record| record.leak)
        );
    }
    text.push('\n');
}

/// The tables of what is predicted worst and of what is chosen worst.
fn worst(text: &mut String, cells: &Cells) {
    let chosen = |cell: &Cell| cell.regret(cell.named("least-error"));
    let mut by_rank: Vec<&Cell> = cells.all.iter().filter(|cell| cell.agreement().is_finite()).collect();
    by_rank.sort_by(|a, b| a.agreement().total_cmp(&b.agreement()));
    let mut by_regret: Vec<&Cell> = cells.all.iter().collect();
    by_regret.sort_by(|a, b| chosen(b).total_cmp(&chosen(a)));
    for (what, ordered, count) in
        [("worst ranked", by_rank, WORST[0]), ("worst chosen by least-error", by_regret, WORST[1])]
    {
        let _ = writeln!(
            text,
            "| {what} | size | Spearman | chosen κλ | best κλ | wrong, % | best, % | regret | worst of the sweep ÷ best |\n\
             |---|--:|--:|--:|--:|--:|--:|--:|--:|"
        );
        for cell in ordered.into_iter().take(count) {
            let (choice, best) = (cell.named("least-error"), cell.best());
            let widest = cell.swept.iter().map(|record| cell.regret(record)).fold(0.0, f64::max);
            let _ = writeln!(
                text,
                "| {} | {} | {:.2} | {:.2} | {} | {:.3} | {:.3} | {:+.1} % | {:.2} |",
                cell.case,
                cell.size,
                cell.agreement(),
                choice.applied,
                best.strength,
                100.0 * choice.wrong,
                100.0 * best.wrong,
                100.0 * chosen(cell),
                1.0 + widest
            );
        }
        text.push('\n');
    }
}

/// The table of cases.
fn cases(text: &mut String, cells: &Cells) {
    let thirds = |record: &Record| record.thirds.map(|third| format!("{:.2}", 100.0 * third)).join(" / ");
    let _ = writeln!(
        text,
        "| case | size | {} | best (κλ) | thirds, fsm | thirds, least-error |\n|---|--:|{}--:|--:|--:|",
        IN_CASES.join(" | "),
        "--:|".repeat(IN_CASES.len())
    );
    for cell in cells.all.iter().filter(|cell| cell.set != "tour") {
        let least = IN_CASES.iter().map(|name| cell.named(name).wrong).fold(f64::INFINITY, f64::min);
        let share = |name: &str| {
            let wrong = cell.named(name).wrong;
            if wrong == least { format!("**{:.3}**", 100.0 * wrong) } else { format!("{:.3}", 100.0 * wrong) }
        };
        let best = cell.best();
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.3} ({}) | {} | {} |",
            cell.case,
            cell.size,
            IN_CASES.map(share).join(" | "),
            100.0 * best.wrong,
            best.strength,
            thirds(cell.fsm()),
            thirds(cell.named("least-error"))
        );
    }
    text.push('\n');
}

const PICTURES: &str = "![error over strength](warps-sweep.svg)\n\n\
One curve per case, taken at even steps from the case that gains most by its best strength to the one that gains least.\n\n\
![error over depth in one dimension](errors-of-depth.svg)\n\n\
In one dimension the sum of 1/E over the logarithm of depth is the same for every map: a warp moves error, it does not remove it. What it \
buys in a picture depends on where shadow edges are seen, and has to be measured.\n\n";

const TECHNIQUES_TEXT: &str = "## Techniques\n\n\
Wrong pixels are those more than half off the centre truth. *÷ fsm*: their number over that of the focused map, geometric mean; *worst* \
and *where*: the largest such ratio. *Within*: the share of the pairs whose picture has at most so many more wrong pixels than \
the best strength of the sweep; *regret*: how many more in the mean (least-error has an axis of its own and can be better than the best of the sweep). \
*Above*: pairs with more than so many times the focused map's wrong pixels. *Acne* and *leak*: the worst picture of maps of 2048 texels, false \
shadow and false light more than two pixels away from any edge, % of the pixels. *As printed*: the strength and the axis of the paper, no guard.\n\n";

const PURCHASES: &str = "Against the focused map, over all pairs; *better* and *worse* mean by as much as *above* does. Thirds are parts of equal \
count by eye depth, near, middle, far; the numbers are wrong pixels of all pictures together, as multiples of the focused map's.\n";

const PREDICTION: &str = "A fit predicts the error of its picture (`ShadowFrame::predicted.error`) from the light, the camera and the \
points that are seen, before anything is drawn; that is what least-error minimises, with its reluctance to strong warps in it.";

const CASES: &str = "## Cases\n\nWrong pixels, %; techniques guarded, the least of a row in bold; thirds: near / middle / far, each in % \
of its third.\n\n";

const BIAS: &str = "## Bias\n\n\
- The constants of the prediction were chosen on these scenes; other scenes can be swept by naming their folder in `ANTUMBRA_SCENES`.\n\
- A map takes no stronger warp than its border allows: on small maps the last strengths of the sweep may be one and the same picture.\n\
- Wrong pixels count every edge alike; a viewer may mind the near ones more, and then the tables by thirds matter, not their sum.\n\
- One map, directional light, 2×2 lookup, automatic bias, still pictures. What moves is tested elsewhere (`tests/continuity.rs`).\n";
