//! SMRA plus against the best of the others, and against two engines.

use std::fmt::Write as _;

use antumbra::lab::statistics::geometric_mean;

use crate::duel::{Duel, Set, holds};
use crate::measure::Record;
use crate::peers::peer;
use crate::pictures::Shown;
use crate::programme::{PLUS, RIVALS, SSM};

/// No case may have more than this times the mean error of the best of the others.
const NO_WORSE: f64 = 1.05;

/// Root mean square error over the better engine's, geometric mean, by size: what is aimed at; and in any one case.
const AIMS: [(u32, f64); 3] = [(512, 0.7), (1024, 0.7), (2048, 0.85)];
const NO_CASE_ABOVE: f64 = 1.0;

/// How far a floor may be from the published one, as a share of it.
const SAME_FLOOR: f64 = 0.02;

/// The picture in which SMRA plus has most mean error over that of the best of the others, or gains least.
pub(crate) fn worst(records: &[Record]) -> Result<Shown, String> {
    let set = Set { records, shared: false };
    let pairs = set.of(PLUS, None).filter_map(|ours| Some((ours, set.best(ours, &RIVALS, |r| r.mae)?)));
    let found = pairs.max_by(|a, b| (a.0.mae / a.1.mae).total_cmp(&(b.0.mae / b.1.mae)));
    let (ours, theirs) = found.ok_or("no picture of SMRA plus beside others")?;
    Ok(Shown::of(ours, &[theirs.name, PLUS], "worst.jpg"))
}

/// That picture.
pub(crate) fn look_at_worst(text: &mut String, set: Set, shown: &Shown) {
    let error = |name: &str| {
        let found = set.of(name, Some(shown.size)).find(|r| r.scene == shown.scene && r.case == shown.case);
        found.map_or_else(String::new, |r| format!("{name} {:.3} %", 100.0 * r.mae))
    };
    let _ = writeln!(
        text,
        "\n![Where SMRA plus gains least](thesis/{})\n\n*{}/{} at {}, the picture with the largest ratio, where the two differ most; below, red where light leaks, blue where shadow \
         is false. Mean error of the whole picture: {}.*",
        shown.file,
        shown.scene,
        shown.case,
        shown.size,
        shown.names.iter().map(|name| error(name)).collect::<Vec<_>>().join(", ")
    );
}

/// Excess and mean error beside those of the best, case by case, and what they come to.
pub(crate) fn against_the_best(text: &mut String, set: Set) {
    let best = |ours: &Record, figure: fn(&Record) -> f64| set.best(ours, &RIVALS, figure);
    text.push_str("\n| picture | excess, % | least excess of the others, % | of | mean error, ratio to the least |\n|---|--:|--:|---|--:|\n");
    for ours in set.of(PLUS, None) {
        let (Some(excess), Some(error)) = (best(ours, |r| r.excess), best(ours, |r| r.mae)) else { continue };
        let ratio = ours.mae / error.mae;
        let mark = if ratio > NO_WORSE { "**" } else { "" };
        let _ = writeln!(
            text,
            "| {} | {:.3} | {:.3} | {} | {mark}{ratio:.3}{mark} |",
            crate::duel::place(ours),
            100.0 * ours.excess,
            100.0 * excess.excess,
            excess.name
        );
    }
    let pairs =
        |figure: fn(&Record) -> f64| set.of(PLUS, None).filter_map(move |ours| Some((ours, best(ours, figure)?)));
    let error = Duel::of(pairs(|r| r.mae), |r| r.mae);
    let excess = Duel::of(pairs(|r| r.excess), |r| r.excess);
    let _ = writeln!(
        text,
        "\nSMRA plus has the lower excess in {} of {} pictures. Mean error over that of the best of the others: geometric mean {:.3}, worst {:.3} ({}); more \
         than {NO_WORSE} in {} pictures: the bound of 5 % {}. {}",
        excess.lower,
        excess.count,
        error.mean,
        error.worst,
        error.place,
        error.above(NO_WORSE),
        holds(error.above(NO_WORSE) == 0),
        positive(pairs(|r| r.excess))
    );
    smaller_maps(text, set);
}

/// The ratio of excesses where it means something.
fn positive<'a>(pairs: impl Iterator<Item = (&'a Record, &'a Record)>) -> String {
    let all: Vec<[f64; 2]> = pairs.map(|(ours, theirs)| [ours.excess, theirs.excess]).collect();
    let ratios: Vec<f64> = all.iter().filter(|pair| pair.iter().all(|e| *e > 0.0)).map(|[a, b]| a / b).collect();
    let negative = all.iter().filter(|pair| pair[0] <= 0.0).count();
    let of_both = if ratios.is_empty() {
        "no picture has both above 0".to_owned()
    } else {
        format!(
            "where both are above 0, in {} pictures, its ratio has a geometric mean of {:.3}",
            ratios.len(),
            geometric_mean(&ratios)
        )
    };
    format!(
        "Excess is negative where a filter beats a perfect hard edge, and ratios mean nothing there: SMRA plus is at or below 0 in {negative} of {}; {of_both}.",
        all.len()
    )
}

/// The smallest maps of SMRA plus against the largest standard map.
fn smaller_maps(text: &mut String, set: Set) {
    let sizes = set.sizes();
    let (Some(&small), Some(&large)) = (sizes.first(), sizes.last()) else { return };
    let pairs = || set.of(PLUS, Some(small)).filter_map(|ours| Some((ours, set.sized(ours, SSM, large)?)));
    let (error, wrong, excess) =
        (Duel::of(pairs(), |r| r.mae), Duel::of(pairs(), |r| r.wrong), Duel::of(pairs(), |r| r.excess));
    let texels = 4.0 * f64::from(small).powi(2) / f64::from(large).powi(2);
    let _ = writeln!(
        text,
        "\nSMRA plus at {small} against {SSM} at {large}, with {texels:.2} times its texels: lower excess in {} of {} views, lower mean error in {}, {:.2} times it \
         in the geometric mean, {:.2} times in the worst ({}); {:.2} times the wrong pixels.",
        excess.lower, excess.count, error.lower, error.mean, error.worst, error.place, wrong.mean
    );
}

/// Root mean square errors beside two engines'.
pub(crate) fn against_engines(text: &mut String, set: Set) {
    text.push_str(
        "\n| case | size | floor | SMRA plus | Bevy 0.19.1 | three.js 0.187 | ratio to the better |\n|---|--:|--:|--:|--:|--:|--:|\n",
    );
    let mut ratios: Vec<(u32, f64, String)> = Vec::new();
    let mut drift = 0.0_f64;
    for ours in set.of(PLUS, None) {
        let Some(peer) = peer(&ours.case, ours.size) else { continue };
        let ratio = ours.rmse / peer.better();
        drift = drift.max((ours.floor[0] / peer.floor - 1.0).abs());
        let _ = writeln!(
            text,
            "| {} | {} | {:.4} | {:.4} | {:.4} | {:.4} | {ratio:.3} |",
            peer.case, peer.size, ours.floor[0], ours.rmse, peer.bevy, peer.three
        );
        ratios.push((ours.size, ratio, crate::duel::place(ours)));
    }
    text.push('\n');
    for (size, aim) in AIMS {
        let these: Vec<f64> = ratios.iter().filter(|(known, ..)| *known == size).map(|(_, ratio, _)| *ratio).collect();
        if !these.is_empty() {
            let mean = geometric_mean(&these);
            let _ = writeln!(text, "- At {size}: geometric mean {mean:.3}; the bound of {aim} {}.", holds(mean <= aim));
        }
    }
    if let Some((_, ratio, place)) = ratios.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
        let _ = writeln!(
            text,
            "- Worst case: {ratio:.3} ({place}); none above {NO_CASE_ABOVE:.1}: {}.",
            holds(*ratio <= NO_CASE_ABOVE)
        );
    }
    let _ = writeln!(
        text,
        "- Largest difference of a floor from the one that the engines were measured with: {:.1} %; within {:.0} %: {}.",
        100.0 * drift,
        100.0 * SAME_FLOOR,
        holds(drift <= SAME_FLOOR)
    );
}
