//! Each step from the standard map to SMRA and to SMRA plus: what it changes.

use std::fmt::Write as _;

use antumbra::lab::statistics::mean;

use crate::duel::{Duel, Set};
use crate::measure::{Record, Times};
use crate::programme::{STEP_SIDE, steps};

/// Bytes of a MiB.
const MEBI: f64 = 1_048_576.0;

/// Change of the mean error, as a share, that is called one: less is chance of a few pixels.
const NOTICEABLE: f64 = 0.005;

/// One line a step, and the steps that pay and that do not.
pub(crate) fn table(text: &mut String, set: Set) {
    text.push_str(
        "\n| step | change | to | maps | mean error, % | excess, % | ÷ before | lower in | wrong, % | leak, % | acne, % | fit, µs | total, ms | MiB |\n\
         |---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    let (mut pay, mut cost, mut same) = (Vec::new(), Vec::new(), Vec::new());
    for step in steps() {
        let of =
            |figure: &dyn Fn(&Record) -> f64| mean(&set.of(step.name, Some(STEP_SIDE)).map(figure).collect::<Vec<_>>());
        let time = |figure: &dyn Fn(&Times) -> f64| of(&|r| r.times.as_ref().map_or(f64::NAN, figure));
        let pairs = set.of(step.name, Some(STEP_SIDE)).filter_map(|r| Some((r, set.beside(r, step.from)?)));
        let duel = Duel::of(pairs, |r| r.mae);
        let (ratio, lower) = if duel.count == 0 {
            ("–".to_owned(), "–".to_owned())
        } else {
            let sentence = format!("*{}* ({:.3} times the mean error of *{}*)", step.name, duel.mean, step.from);
            let (less, more) = (duel.mean < 1.0 - NOTICEABLE, duel.mean > 1.0 + NOTICEABLE);
            if less {
                &mut pay
            } else if more {
                &mut cost
            } else {
                &mut same
            }
            .push(sentence);
            (format!("{:.3}", duel.mean), format!("{} of {}", duel.lower, duel.count))
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.1} | {:.3} | {:.3} | {ratio} | {lower} | {:.3} | {:.4} | {:.4} | {:.1} | {:.1} ± {:.1} | {:.1} |",
            step.name,
            step.change,
            if step.from.is_empty() { "–" } else { step.from },
            of(&|r| r.maps as f64),
            100.0 * of(&|r| r.mae),
            100.0 * of(&|r| r.excess),
            100.0 * of(&|r| r.wrong),
            100.0 * of(&|r| r.leak),
            100.0 * of(&|r| r.acne),
            1000.0 * time(&|times| times.fit),
            time(&|times| times.total),
            time(&|times| times.spread),
            of(&|r| r.bytes as f64) / MEBI
        );
    }
    let _ = writeln!(text, "\nSteps that lower the mean error: {}.", list(&pay));
    let _ = writeln!(text, "\nSteps that raise it: {}.", list(&cost));
    let _ = writeln!(text, "\nSteps that change it by less than {} %: {}.", 100.0 * NOTICEABLE, list(&same));
}

/// Fewest turns of any picture of it.
pub(crate) fn least_turns(set: Set) -> usize {
    let steps = steps();
    let timed = steps.iter().flat_map(|step| set.of(step.name, Some(STEP_SIDE))).filter_map(|record| record.times);
    timed.map(|times| times.turns).min().unwrap_or_default()
}

fn list(sentences: &[String]) -> String {
    if sentences.is_empty() { "none".to_owned() } else { sentences.join("; ") }
}
