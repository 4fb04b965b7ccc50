//! SMRA plus against the best of the others, and against two engines.

use std::fmt::Write as _;

use antumbra::lab::statistics::geometric_mean;

use crate::duel::{Duel, Set, holds, place};
use crate::measure::Record;
use crate::peers::peer;
use crate::pictures::{ERROR_COLOURS, Shown};
use crate::programme::{EQUAL_TEXELS, PLUS, Rival, SAME_SIDE, SSM};

/// What is aimed at: error over that of the best of the others, geometric mean; and in any one picture.
const MUCH_BETTER: f64 = 0.7;
const NO_WORSE: f64 = 1.05;

/// Root mean square error over the better engine's, geometric mean, by size: what is aimed at; and in any one case.
const AIMS: [(u32, f64); 3] = [(512, 0.7), (1024, 0.7), (2048, 0.85)];
const NO_CASE_ABOVE: f64 = 1.0;

/// How far a floor may be from the published one, as a share of it.
const SAME_FLOOR: f64 = 0.02;

/// The picture in which SMRA plus has most mean error over that of the best of the others, or gains least.
pub(crate) fn worst(records: &[Record]) -> Result<Shown, String> {
    let set = Set { records, shared: false };
    let pairs = set.of(PLUS, None).filter_map(|ours| Some((ours, set.best(ours, &SAME_SIDE, |r| r.mae)?)));
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
        "\n![Where SMRA plus gains least](thesis/{})\n\n*{}/{} at {}, the picture with the largest ratio among maps of the same side, where the two differ most; below, their errors: {ERROR_COLOURS}. Mean error of the \
         whole picture: {}.*",
        shown.file,
        shown.scene,
        shown.case,
        shown.size,
        shown.names.iter().map(|name| error(name)).collect::<Vec<_>>().join(", ")
    );
}

/// Excess and mean error beside those of the best, picture by picture.
pub(crate) fn by_picture(text: &mut String, set: Set) {
    text.push_str(
        "\n| picture | excess, % | same side: least excess of the others, % | of | mean error ÷ the least | equal texels: least excess of the others, % | of | mean error ÷ the least |\n\
         |---|--:|--:|---|--:|--:|---|--:|\n",
    );
    for ours in set.of(PLUS, None) {
        let beside = |rivals: &[Rival]| {
            let Some(best) = set.best(ours, rivals, |r| r.mae) else { return "– | – | –".to_owned() };
            let ratio = ours.mae / best.mae;
            let mark = if ratio > NO_WORSE { "**" } else { "" };
            let wide = if best.size == ours.size { String::new() } else { format!(" at {}", best.size) };
            format!("{:.3} | {}{wide} | {mark}{ratio:.3}{mark}", 100.0 * best.excess, best.name)
        };
        let (place, excess) = (place(ours), 100.0 * ours.excess);
        let _ = writeln!(text, "| {place} | {excess:.3} | {} | {} |", beside(&SAME_SIDE), beside(&EQUAL_TEXELS));
    }
}

/// Maps of the same side, and equal texels: what it comes to.
pub(crate) fn against_the_best(text: &mut String, set: Set) {
    text.push_str("\n**With maps of the same side.** SMRA plus has four maps, PSSM and SMRA three, the others one.\n");
    Bout { set, rivals: &SAME_SIDE }.write(text);
    let all: Vec<&Record> = set.of(PLUS, None).collect();
    let four = all.iter().filter(|record| record.maps == 4).count();
    let _ = writeln!(
        text,
        "\n**At equal texels.** Others with one map have it twice as wide, PSSM and SMRA have four maps. SMRA plus drew all of its four in {four} of {} pictures.",
        all.len()
    );
    Bout { set, rivals: &EQUAL_TEXELS }.write(text);
    smaller_maps(text, set);
}

/// SMRA plus against the best of some others in each picture: the one with the least mean error has the least excess,
/// for what a perfect hard edge has is the same for all.
#[derive(Clone, Copy)]
struct Bout<'a> {
    set: Set<'a>,
    rivals: &'a [Rival],
}

impl<'a> Bout<'a> {
    fn pairs(self, size: Option<u32>) -> impl Iterator<Item = (&'a Record, &'a Record)> {
        self.set.of(PLUS, size).filter_map(move |ours| Some((ours, self.set.best(ours, self.rivals, |r| r.mae)?)))
    }

    fn error(self, size: Option<u32>) -> Duel {
        Duel::of(self.pairs(size), |r| r.mae)
    }

    /// Where the ratio means something: both above 0.
    fn excess(self, size: Option<u32>) -> Duel {
        let positive = |(ours, theirs): &(&Record, &Record)| ours.excess > 0.0 && theirs.excess > 0.0;
        Duel::of(self.pairs(size).filter(positive), |r| r.excess)
    }

    /// A line a size, and verdicts.
    fn write(self, text: &mut String) {
        text.push_str(
            "\n| size | pictures | lower excess | mean error ÷ the best's | worst | more than 1.05 | excess ÷ the best's, both above 0 | pictures | worst |\n\
             |---|--:|--:|--:|---|--:|--:|--:|---|\n",
        );
        for size in self.set.sizes().into_iter().map(Some).chain([None]) {
            let (error, excess) = (self.error(size), self.excess(size));
            let (mean, worst) = if excess.count == 0 {
                ("–".to_owned(), "–".to_owned())
            } else {
                (format!("{:.3}", excess.mean), format!("{:.3} ({})", excess.worst, excess.place))
            };
            let _ = writeln!(
                text,
                "| {} | {} | {} | {:.3} | {:.3} ({}) | {} | {mean} | {} | {worst} |",
                size.map_or_else(|| "all".to_owned(), |size| size.to_string()),
                error.count,
                error.lower,
                error.mean,
                error.worst,
                error.place,
                error.above(NO_WORSE),
                excess.count
            );
        }
        self.verdicts(text);
    }

    fn verdicts(self, text: &mut String) {
        let (error, excess) = (self.error(None), self.excess(None));
        let sizes = self.set.sizes();
        let by_size = |duel: &dyn Fn(Option<u32>) -> Duel| -> String {
            let at = |size: &u32| {
                let duel = duel(Some(*size));
                let verdict = holds(duel.mean <= MUCH_BETTER);
                if duel.count == 0 {
                    format!("at {size} none")
                } else {
                    format!("at {size} {:.3} {verdict}", duel.mean)
                }
            };
            sizes.iter().map(at).collect::<Vec<_>>().join(", ")
        };
        let _ = writeln!(
            text,
            "\n- At most {MUCH_BETTER} times the best of the others by mean error, geometric mean: {:.3}, {}; {}.",
            error.mean,
            holds(error.mean <= MUCH_BETTER),
            by_size(&|size| self.error(size))
        );
        if excess.count == 0 {
            let _ = writeln!(text, "- The same by excess: no picture has both above 0.");
        } else {
            let _ = writeln!(
                text,
                "- The same by excess, where both are above 0 ({} of {} pictures): {:.3}, {}; {}.",
                excess.count,
                error.count,
                excess.mean,
                holds(excess.mean <= MUCH_BETTER),
                by_size(&|size| self.excess(size))
            );
        }
        let signs = |ours: bool, theirs: bool| {
            self.pairs(None).filter(|(a, b)| (a.excess > 0.0) == ours && (b.excess > 0.0) == theirs).count()
        };
        let lost = signs(true, false);
        let _ = writeln!(
            text,
            "- Excess is negative where a filter beats a perfect hard edge, and ratios mean nothing there. Of {} pictures SMRA plus alone is at or below 0 in {}, both are in {}, \
             the best of the others alone in {lost}.\n\
             - Nowhere more than {NO_WORSE} times the best of the others: by mean error {}, above in {} of {}; by excess {}, above in {} of {} with both above 0, and at or below 0 \
             are the others alone in {lost}.",
            error.count,
            signs(false, true),
            signs(false, false),
            holds(error.above(NO_WORSE) == 0),
            error.above(NO_WORSE),
            error.count,
            holds(excess.above(NO_WORSE) + lost == 0),
            excess.above(NO_WORSE),
            excess.count
        );
    }
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
         in the geometric mean, {:.2} times in the worst ({}); {:.2} times the wrong pixels. At most {SSM}'s error: in the geometric mean {}, in every view {}.",
        excess.lower,
        excess.count,
        error.lower,
        error.mean,
        error.worst,
        error.place,
        wrong.mean,
        holds(error.mean <= 1.0),
        holds(error.above(1.0) == 0)
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
        ratios.push((ours.size, ratio, place(ours)));
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
