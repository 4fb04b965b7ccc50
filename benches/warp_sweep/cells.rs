//! Cells: one case at one map size, with all its pictures.

use antumbra::lab::statistics::rank_correlation;

use crate::record::{Record, Sweep};

/// Focused maps with fewer wrong pixels than this share leave nothing to gain: 48 pixels of 800 × 600. Ratios to less
/// are noise; ten times more would leave out large maps of small scenes.
pub(crate) const LEAST_WRONG: f64 = 1e-4;
/// Half a pixel of 800 × 600: stands for none where a ratio is taken.
const HALF_A_PIXEL: f64 = 1e-6;

/// One case at one size.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) set: String,
    /// The case, with its scene where its own name does not tell.
    pub(crate) case: String,
    /// Side of the map, texels.
    pub(crate) size: u32,
    /// By rising strength.
    pub(crate) swept: Vec<Record>,
    named: Vec<Record>,
}

/// All cells that can be compared, and how many cannot.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    pub(crate) all: Vec<Cell>,
    /// Left out: so little is wrong that nothing can be gained.
    pub(crate) flawless: usize,
    /// Left out: a run failed.
    pub(crate) failed: usize,
}

impl Cells {
    /// Groups what was measured.
    pub(crate) fn of(sweep: &Sweep) -> Result<Self, String> {
        let mut all: Vec<Cell> = Vec::new();
        for record in &sweep.records {
            let case = label(record);
            if all.last().is_none_or(|cell| (&cell.set, &cell.case, cell.size) != (&record.set, &case, record.size)) {
                let (swept, named) = (Vec::new(), Vec::new());
                all.push(Cell { set: record.set.clone(), case, size: record.size, swept, named });
            }
            let Some(cell) = all.last_mut() else { continue };
            let kind = if record.strength.parse::<f64>().is_ok() { &mut cell.swept } else { &mut cell.named };
            kind.push(record.clone());
        }
        let (whole, failed): (Vec<_>, Vec<_>) = all.into_iter().partition(Cell::is_whole);
        let (all, flawless): (Vec<_>, Vec<_>) = whole.into_iter().partition(|cell| cell.fsm().wrong >= LEAST_WRONG);
        if all.is_empty() {
            return Err("nothing was swept that can be compared".to_owned());
        }
        Ok(Self { all, flawless: flawless.len(), failed: failed.len() })
    }

    /// How well prediction ranks every size and strength of a case, one number a case of `set`: Spearman's rank
    /// correlation.
    pub(crate) fn agreement_within_cases(&self, set: &str) -> Vec<f64> {
        let cases =
            self.all.chunk_by(|a, b| (&a.set, &a.case) == (&b.set, &b.case)).filter(|cells| cells[0].set == set);
        let ranks = cases.map(|cells| rank_correlation(&cells.iter().flat_map(Cell::pairs).collect::<Vec<_>>()));
        ranks.filter(|rank| rank.is_finite()).collect()
    }

    pub(crate) fn of_set<'a>(&'a self, set: &'a str) -> impl Iterator<Item = &'a Cell> {
        self.all.iter().filter(move |cell| cell.set == set)
    }
}

impl Cell {
    fn is_whole(&self) -> bool {
        let records = || self.swept.iter().chain(&self.named);
        records().all(|record| record.wrong.is_finite())
            && self.swept.len() == crate::measure::STRENGTHS.len()
            && self.named.len() == crate::measure::NAMED.len()
    }

    /// A technique's picture; the best swept one for any other name.
    pub(crate) fn named(&self, name: &str) -> &Record {
        self.named.iter().find(|record| record.strength == name).unwrap_or_else(|| self.best())
    }

    /// The picture of the focused map.
    pub(crate) fn fsm(&self) -> &Record {
        self.named("fsm")
    }

    /// The best picture of the sweep.
    pub(crate) fn best(&self) -> &Record {
        let less =
            |best: usize, index: usize| if self.swept[index].wrong < self.swept[best].wrong { index } else { best };
        &self.swept[(0..self.swept.len()).fold(0, less)]
    }

    /// Wrong pixels of a picture, as a multiple of the focused map's.
    pub(crate) fn of_fsm(&self, record: &Record) -> f64 {
        record.wrong.max(HALF_A_PIXEL) / self.fsm().wrong
    }

    /// Wrong pixels beyond the best of the sweep, as a share of that; negative where a picture is better.
    pub(crate) fn regret(&self, record: &Record) -> f64 {
        record.wrong.max(HALF_A_PIXEL) / self.best().wrong.max(HALF_A_PIXEL) - 1.0
    }

    /// How well prediction ranks the strengths of the sweep: Spearman's rank correlation.
    pub(crate) fn agreement(&self) -> f64 {
        rank_correlation(&self.pairs().collect::<Vec<_>>())
    }

    /// Predicted and measured errors of the sweep.
    fn pairs(&self) -> impl Iterator<Item = [f64; 2]> {
        self.swept.iter().map(|record| [record.predicted, record.wrong])
    }

    /// Predicted and measured error of a picture, as multiples of those without a warp.
    pub(crate) fn predicted_and_measured(&self, record: &Record) -> [f64; 2] {
        let none = &self.swept[0];
        [record.predicted / none.predicted, record.wrong.max(HALF_A_PIXEL) / none.wrong.max(HALF_A_PIXEL)]
    }
}

/// A name for a case that tells it from all others of its set.
fn label(record: &Record) -> String {
    if record.set == "shared" { record.case.clone() } else { format!("{}/{}", record.scene, record.case) }
}
