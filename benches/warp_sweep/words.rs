//! Sentences that are made from the numbers.

use antumbra::lab::statistics::{geometric_mean, quantile};

use crate::cells::{Cell, Cells};

/// What counts as a difference: less is noise of single pixels.
pub(crate) const NOTICEABLE: f64 = 0.03;

const THIRDS: [&str; 3] = ["near", "middle", "far"];

/// What a published warp buys, as printed and guarded.
pub(crate) fn purchase(cells: &Cells, name: &str) -> String {
    let unguarded = format!("{name} unguarded");
    let (printed, guarded) = (Purchase::of(cells, &unguarded), Purchase::of(cells, name));
    format!(
        "- **{name}** as printed {} {} Guarded it {} {}",
        printed.total(),
        printed.by_third(),
        guarded.total(),
        guarded.by_third()
    )
}

/// What one warp without a guard buys.
pub(crate) fn purchase_of_own(cells: &Cells, name: &str) -> String {
    let bought = Purchase::of(cells, name);
    format!("- **{name}** {} {}", bought.total(), bought.by_third())
}

struct Purchase {
    /// Wrong pixels as multiples of the focused map's: geometric mean, least, most.
    mean: f64,
    range: [f64; 2],
    /// Shares of the cells that are noticeably better and worse.
    better: f64,
    worse: f64,
    /// Wrong pixels of each third in all cells together, as multiples of the focused map's.
    thirds: [f64; 3],
}

impl Purchase {
    fn of(cells: &Cells, name: &str) -> Self {
        let ratios: Vec<f64> = cells.all.iter().map(|cell| cell.of_fsm(cell.named(name))).collect();
        let share = |holds: &dyn Fn(f64) -> bool| {
            ratios.iter().filter(|ratio| holds(**ratio)).count() as f64 / ratios.len() as f64
        };
        let total =
            |third: usize, name: &str| -> f64 { cells.all.iter().map(|cell| cell.named(name).thirds[third]).sum() };
        Self {
            mean: geometric_mean(&ratios),
            range: [quantile(&ratios, 0.0), quantile(&ratios, 1.0)],
            better: share(&|ratio| ratio < 1.0 - NOTICEABLE),
            worse: share(&|ratio| ratio > 1.0 + NOTICEABLE),
            thirds: [0, 1, 2].map(|third| total(third, name) / total(third, "fsm")),
        }
    }

    fn total(&self) -> String {
        let Self { mean, range: [least, most], better, worse, .. } = self;
        format!(
            "leaves {mean:.2} times the wrong pixels ({least:.2} to {most:.2}): {:.0} % of the pictures are better, {:.0} % worse.",
            100.0 * better,
            100.0 * worse
        )
    }

    /// Who pays and who gains.
    fn by_third(&self) -> String {
        let [near, middle, far] = self.thirds;
        let which = |holds: &dyn Fn(f64) -> bool| -> Vec<&str> {
            THIRDS.into_iter().zip(self.thirds).filter(|(_, third)| holds(*third)).map(|(name, _)| name).collect()
        };
        let (gain, lose) = (which(&|third| third < 1.0 - NOTICEABLE), which(&|third| third > 1.0 + NOTICEABLE));
        let verdict = match (gain.as_slice(), lose.as_slice()) {
            ([], []) => "no third of the picture changes noticeably".to_owned(),
            (gain, []) => format!("{} and nothing is paid elsewhere", thirds(gain, "gains", "gain")),
            ([], lose) => format!("{} and nothing is gained elsewhere", thirds(lose, "loses", "lose")),
            (gain, lose) => format!("{}, {}", thirds(gain, "gains", "gain"), thirds(lose, "pays", "pay")),
        };
        format!("By thirds of the picture {near:.2}, {middle:.2}, {far:.2}: {verdict}.")
    }
}

/// "the near third gains", "the near and far thirds gain".
fn thirds(names: &[&str], one: &str, many: &str) -> String {
    match names {
        [name] => format!("the {name} third {one}"),
        names if names.len() == THIRDS.len() => format!("all {many}"),
        names => format!("the {} thirds {many}", names.join(" and ")),
    }
}

/// How well prediction ranks strengths.
pub(crate) fn agreement(cells: &Cells) -> String {
    let of = |wanted: &dyn Fn(&Cell) -> bool| -> Vec<f64> {
        let ranks = cells.all.iter().filter(|cell| wanted(cell)).map(Cell::agreement);
        ranks.filter(|rank| rank.is_finite()).collect()
    };
    let all = of(&|_| true);
    let at = |share: f64| quantile(&all, share);
    let mut sizes: Vec<u32> = cells.all.iter().map(|cell| cell.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let by_size = sizes.iter().map(|size| format!("{:.2} at {size}", quantile(&of(&|cell| cell.size == *size), 0.5)));
    let by_set = crate::page::SETS.into_iter().filter(|(set, _)| cells.of_set(set).next().is_some());
    let by_set = by_set.map(|(set, name)| format!("{:.2} in {name}", quantile(&of(&|cell| cell.set == set), 0.5)));
    let within = crate::page::SETS.map(|(set, name)| (cells.agreement_within_cases(set), name));
    let cases: Vec<f64> = within.iter().flat_map(|(ranks, _)| ranks.iter().copied()).collect();
    let within = within.iter().filter(|(ranks, _)| !ranks.is_empty());
    let within = within.map(|(ranks, name)| format!("{:.2} in {name}", quantile(ranks, 0.5)));
    format!(
        "Spearman's rank correlation of predicted error and wrong pixels over all sizes and strengths of a case: median **{:.2}** of {} cases, \
         a quarter below {:.2}; {}. Sizes are easily ranked. Over the strengths of one case at one size: median **{:.2}** of {}, \
         a quarter below {:.2}, a tenth below {:.2}, least {:.2}. Medians {}; {}. {}",
        quantile(&cases, 0.5),
        cases.len(),
        quantile(&cases, 0.25),
        within.collect::<Vec<_>>().join(", "),
        at(0.5),
        all.len(),
        at(0.25),
        at(0.1),
        at(0.0),
        by_size.collect::<Vec<_>>().join(", "),
        by_set.collect::<Vec<_>>().join(", "),
        distance(cells)
    )
}

/// How far measured errors are from predicted ones.
fn distance(cells: &Cells) -> String {
    let off = |cell: &Cell| -> Vec<f64> {
        let bent = cell.swept.iter().filter(|record| record.applied > 0.0);
        bent.map(|record| cell.predicted_and_measured(record))
            .map(|[predicted, measured]| (measured / predicted).ln().abs())
            .collect()
    };
    let all: Vec<f64> = cells.all.iter().flat_map(off).filter(|value| value.is_finite()).collect();
    format!(
        "Both as multiples of those without a warp, half of the {} warped pictures lie within a factor of {:.2} of what was predicted, \
         nine tenths within {:.2}.",
        all.len(),
        quantile(&all, 0.5).exp(),
        quantile(&all, 0.9).exp()
    )
}
