//! The main table, and the thesis's claim put to the test.

use std::fmt::Write as _;

use antumbra::lab::statistics::mean;

use crate::duel::{Duel, Set};
use crate::measure::Record;
use crate::pictures::{ERROR_COLOURS, Shown};
use crate::programme::{CONTRIBUTORS, PSSM, SMRA, UNFILTERED};

/// What "far" asks for: mean error over that of the best contributor. At 1 any gain would do; at ½ hardly any would.
const FAR: f64 = 0.8;

/// The picture in which trapezoids do parallel splits most harm, or least good, with the smallest maps.
pub(crate) fn most_harm(records: &[Record]) -> Result<Shown, String> {
    let set = Set { records, shared: false };
    let smallest = set.sizes().first().copied();
    let harm = |record: &&Record| set.beside(record, PSSM).map_or(0.0, |plain| record.wrong - plain.wrong);
    let found = set.of(UNFILTERED, smallest).max_by(|a, b| harm(a).total_cmp(&harm(b)));
    let found = found.ok_or("no picture of parallel splits with trapezoids")?;
    Ok(Shown::of(found, &[PSSM, UNFILTERED, SMRA], "why.jpg"))
}

/// Errors of every technique at every size, mean over viewpoints.
pub(crate) fn table(text: &mut String, set: Set, scene: Option<&str>, names: &[&str]) {
    text.push_str("\n| technique | size | excess, % | mean error, % | wrong, % | leak, % | acne, % |\n|---|--:|--:|--:|--:|--:|--:|\n");
    let mut sizes: Vec<u32> = set.all().map(|record| record.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    for name in names {
        for &size in &sizes {
            let here = |record: &&Record| scene.is_none_or(|scene| record.scene == scene);
            let these: Vec<&Record> = set.of(name, Some(size)).filter(here).collect();
            if these.is_empty() {
                continue;
            }
            let mean =
                |figure: fn(&Record) -> f64| 100.0 * these.iter().map(|r| figure(r)).sum::<f64>() / these.len() as f64;
            let _ = writeln!(
                text,
                "| {name} | {size} | {:.3} | {:.3} | {:.3} | {:.4} | {:.4} |",
                mean(|r| r.excess),
                mean(|r| r.mae),
                mean(|r| r.wrong),
                mean(|r| r.leak),
                mean(|r| r.acne)
            );
        }
    }
}

/// SMRA against each contributor, and against the best of them.
pub(crate) fn far_superior(text: &mut String, set: Set) {
    text.push_str(
        "\n| SMRA against | pictures | lower mean error | mean error, ratio | worst | fewer wrong | wrong, ratio | leak, SMRA and other, % |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for name in CONTRIBUTORS {
        let pairs = || set.of(SMRA, None).filter_map(|ours| Some((ours, set.beside(ours, name)?)));
        let (error, wrong) = (Duel::of(pairs(), |r| r.mae), Duel::of(pairs(), |r| r.wrong));
        let leaks = [SMRA, name].map(|name| format!("{:.4}", 100.0 * set.mean(name, None, |r| r.leak)));
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {:.2} | {:.2} | {} | {:.2} | {} |",
            error.count,
            error.lower,
            error.mean,
            error.worst,
            wrong.lower,
            wrong.mean,
            leaks.join(", ")
        );
    }
    let contributors = CONTRIBUTORS.map(|name| (name, 1));
    let best = |figure: fn(&Record) -> f64| {
        Duel::of(set.of(SMRA, None).filter_map(|ours| Some((ours, set.best(ours, &contributors, figure)?))), figure)
    };
    let (error, wrong) = (best(|r| r.mae), best(|r| r.wrong));
    let verdict = if error.lower == error.count && error.mean <= FAR {
        "**The claim holds**"
    } else if error.mean <= FAR {
        "**The claim holds in the mean and not picture by picture**"
    } else if error.mean < 1.0 {
        "**SMRA is better in the mean, and not by far**"
    } else {
        "**The claim does not hold**"
    };
    let _ = writeln!(
        text,
        "\n\"Far better than any of the contributors\": against the best of the four in each picture SMRA has the lower mean error in {} of {}, \
         {:.2} times it in the geometric mean and {:.2} times in the worst ({}); fewer wrong pixels in {} of {}, {:.2} times as many in the \
         geometric mean. {verdict}, if far means {FAR} times the best contributor's mean error.",
        error.lower, error.count, error.mean, error.worst, error.place, wrong.lower, wrong.count, wrong.mean
    );
}

/// What trapezoids do to parallel splits, without a filter on either side.
pub(crate) fn trapezoids(text: &mut String, set: Set, shown: &Shown) {
    let pairs = || set.of(UNFILTERED, None).filter_map(|ours| Some((ours, set.beside(ours, PSSM)?)));
    let (error, wrong) = (Duel::of(pairs(), |r| r.mae), Duel::of(pairs(), |r| r.wrong));
    let third = |name: &str, third: usize| set.mean(name, None, |r| r.thirds[third]);
    let thirds = [0, 1, 2].map(|at| third(UNFILTERED, at) / third(PSSM, at));
    let _ = writeln!(
        text,
        "SMRA's maps without the filter and the grazing rule (*{UNFILTERED}*) against *{PSSM}*, which has neither: fewer wrong pixels in {} of \
         {} pictures, {:.2} times as many in the geometric mean, {:.2} times in the worst ({}); mean error {:.2} times. By thirds of the picture, \
         near, middle, far: {:.2}, {:.2}, {:.2} times the wrong pixels{}.",
        wrong.lower,
        wrong.count,
        wrong.mean,
        wrong.worst,
        wrong.place,
        error.mean,
        thirds[0],
        thirds[1],
        thirds[2],
        trade(thirds)
    );
    let here = |record: &&Record| record.scene == shown.scene && record.case == shown.case;
    let texel = |name: &str, at: usize, everywhere: bool| {
        let these = set.of(name, Some(shown.size)).filter(|record| everywhere || here(record));
        mean(&these.filter_map(|r| r.artefacts).map(|artefacts| artefacts.perspective[at]).collect::<Vec<_>>())
    };
    let [median, high] = [0, 1].map(|at| [PSSM, UNFILTERED].map(|name| texel(name, at, true)));
    let [median_here, high_here] = [0, 1].map(|at| [PSSM, UNFILTERED].map(|name| texel(name, at, false)));
    let _ = writeln!(
        text,
        "At {}, half of what is seen has texels of at most {:.2} pixels under {PSSM} and {:.2} under {UNFILTERED}, 19 in 20 at most {:.2} and {:.2} (perspective part, \
         mean over viewpoints); in the picture below {:.2} and {:.2}, {:.2} and {:.2}.",
        shown.size, median[0], median[1], high[0], high[1], median_here[0], median_here[1], high_here[0], high_here[1]
    );
    let name = format!("{}/{} at {}", shown.scene, shown.case, shown.size);
    let find = |name: &str| set.of(name, Some(shown.size)).find(here).map_or(f64::NAN, |r| 100.0 * r.wrong);
    let _ = writeln!(
        text,
        "\n![Where trapezoids cost most](thesis/why.jpg)\n\n*{name}, the picture in which the trapezoids cost most (or gain least) at that size, where \
         the two differ most. Above: {PSSM}, {UNFILTERED}, {SMRA}; below, their errors: {ERROR_COLOURS}. Wrong pixels \
         of the whole picture: {:.2} %, {:.2} %, {:.2} %.*",
        find(PSSM),
        find(UNFILTERED),
        find(SMRA)
    );
}

/// Who pays for whom.
fn trade(thirds: [f64; 3]) -> String {
    let of = |holds: &dyn Fn(f64) -> bool, one: &str| {
        let names: Vec<&str> = ["near", "middle", "far"]
            .into_iter()
            .zip(thirds)
            .filter(|(_, third)| holds(*third))
            .map(|(name, _)| name)
            .collect();
        match names.as_slice() {
            [] => format!("none {one}s"),
            [name] => format!("the {name} third {one}s"),
            names if names.len() == thirds.len() => format!("all {one}"),
            names => format!("the {} thirds {one}", names.join(" and ")),
        }
    };
    format!(": {}, {}", of(&|third| third < 1.0, "gain"), of(&|third| third > 1.0, "lose"))
}
