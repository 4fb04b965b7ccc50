//! One technique against others, picture by picture.

use antumbra::lab::statistics::geometric_mean;

use crate::measure::Record;
use crate::programme::{PLUS, Rival};

/// Figures below this count as this where a ratio is taken: half a pixel of 800 × 600, or a mean error of as much.
const LEAST: f64 = 1e-6;

/// Records of one set.
#[derive(Clone, Copy)]
pub(crate) struct Set<'a> {
    pub(crate) records: &'a [Record],
    pub(crate) shared: bool,
}

impl<'a> Set<'a> {
    pub(crate) fn all(self) -> impl Iterator<Item = &'a Record> {
        self.records.iter().filter(move |record| record.shared == self.shared)
    }

    pub(crate) fn of(self, name: &str, size: Option<u32>) -> impl Iterator<Item = &'a Record> {
        self.all().filter(move |record| record.name == name && size.is_none_or(|size| record.size == size))
    }

    /// Another technique's record of the same picture.
    pub(crate) fn beside(self, record: &Record, name: &str) -> Option<&'a Record> {
        self.sized(record, name, record.size)
    }

    /// Another technique's record of the same view with maps of another size.
    pub(crate) fn sized(self, record: &Record, name: &str, size: u32) -> Option<&'a Record> {
        self.of(name, Some(size)).find(|other| other.scene == record.scene && other.case == record.case)
    }

    /// The one with the least of a figure among those that saw the same view.
    pub(crate) fn best(self, record: &Record, rivals: &[Rival], figure: fn(&Record) -> f64) -> Option<&'a Record> {
        let found = rivals.iter().filter_map(|(name, times)| self.sized(record, name, times * record.size));
        found.min_by(|a, b| figure(a).total_cmp(&figure(b)))
    }

    /// Mean of a figure.
    pub(crate) fn mean(self, name: &str, size: Option<u32>, figure: impl Fn(&Record) -> f64) -> f64 {
        let values: Vec<f64> = self.of(name, size).map(figure).collect();
        antumbra::lab::statistics::mean(&values)
    }

    /// Sizes of the maps of SMRA plus, ascending: those that all have but for the wide ones.
    pub(crate) fn sizes(self) -> Vec<u32> {
        let mut sizes: Vec<u32> = self.of(PLUS, None).map(|record| record.size).collect();
        sizes.sort_unstable();
        sizes.dedup();
        sizes
    }
}

/// The outcome of many pictures.
pub(crate) struct Duel {
    /// Pictures.
    pub(crate) count: usize,
    /// Those in which ours is lower.
    pub(crate) lower: usize,
    /// Ratio ours over theirs: geometric mean, and the largest.
    pub(crate) mean: f64,
    pub(crate) worst: f64,
    /// Scene, case and size of that one.
    pub(crate) place: String,
    /// Every ratio.
    pub(crate) ratios: Vec<f64>,
}

impl Duel {
    /// Over pairs of ours and theirs.
    pub(crate) fn of<'a>(
        pairs: impl Iterator<Item = (&'a Record, &'a Record)>,
        figure: impl Fn(&Record) -> f64,
    ) -> Self {
        let mut duel =
            Self { count: 0, lower: 0, mean: f64::NAN, worst: 0.0, place: String::new(), ratios: Vec::new() };
        for (ours, theirs) in pairs {
            let [a, b] = [figure(ours), figure(theirs)];
            let ratio = a.max(LEAST) / b.max(LEAST);
            duel.count += 1;
            duel.lower += usize::from(a < b);
            duel.ratios.push(ratio);
            if ratio > duel.worst {
                (duel.worst, duel.place) = (ratio, place(ours));
            }
        }
        duel.mean = geometric_mean(&duel.ratios);
        duel
    }

    /// Ratios above a bound.
    pub(crate) fn above(&self, bound: f64) -> usize {
        self.ratios.iter().filter(|ratio| **ratio > bound).count()
    }
}

/// Scene, case and size.
pub(crate) fn place(record: &Record) -> String {
    let Record { scene, case, size, shared, .. } = record;
    if *shared { format!("{case} at {size}") } else { format!("{scene}/{case} at {size}") }
}

/// Whether a bound holds.
pub(crate) fn holds(held: bool) -> &'static str {
    if held { "holds" } else { "**does not hold**" }
}
