//! Medians over the cases of a set, and who is on a Pareto front.

use antumbra::lab::report::Row;
use antumbra::lab::statistics::pareto_front;

use crate::contenders::Contender;
use crate::measure::{Measured, Record};

/// An error that is plotted against time.
#[derive(Clone, Copy)]
pub(crate) struct Figure {
    /// Part of file names, and heading of tables.
    pub(crate) name: &'static str,
    /// Name of the axis.
    pub(crate) axis: &'static str,
    /// Of a row, %.
    pub(crate) of: fn(&Row) -> f64,
    /// For figures of either sign: where the axis is linear, %.
    pub(crate) linear: Option<f64>,
}

/// What is measured against time.
pub(crate) const FIGURES: [Figure; 3] = [
    Figure {
        name: "excess",
        axis: "mean absolute error above that of a perfect hard edge, %",
        of: |row| 100.0 * row.excess(),
        linear: Some(0.2),
    },
    Figure {
        name: "wrong",
        axis: "pixels wrong against the centre truth, %",
        of: |row| 100.0 * row.wrong_center,
        linear: None,
    },
    Figure {
        name: "leak",
        axis: "light in shadow, away from edges, %",
        of: |row| 100.0 * row.leak_interior,
        linear: None,
    },
];

/// A contender at a size, over the cases of a set.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) name: String,
    /// Place among the contenders: its colour and marker.
    pub(crate) style: usize,
    pub(crate) size: u32,
    /// Medians over cases, in the order of [`FIGURES`], %.
    pub(crate) figures: [f64; 3],
    /// Whether no other cell has less of both a figure and time.
    pub(crate) on_front: [bool; 3],
    /// Median over cases of the time of a frame, milliseconds.
    pub(crate) ms: f64,
    /// Median over cases of half the distance between the quartiles over turns, milliseconds.
    pub(crate) spread_ms: f64,
    pub(crate) bytes: u64,
    pub(crate) cases: usize,
    /// Cases in which it failed.
    pub(crate) failed: usize,
}

/// The median, for which a run that failed is worse than any other; NaN where that is the median.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.map(|value| if value.is_nan() { f64::INFINITY } else { value }).collect();
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return f64::NAN };
    let median = f64::midpoint(values[last / 2], values[values.len() / 2]);
    if median.is_finite() { median } else { f64::NAN }
}

/// Every contender at every size that it was drawn at.
pub(crate) fn cells(measured: &Measured, contenders: &[Contender], sizes: &[u32]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (style, contender) in contenders.iter().enumerate() {
        for &size in sizes {
            let of = |record: &&Record| record.row.technique == contender.name && record.row.size == size;
            let records: Vec<&Record> = measured.records.iter().filter(of).collect();
            if records.is_empty() {
                continue;
            }
            let of = |figure: &dyn Fn(&Record) -> f64| median(records.iter().map(|record| figure(record)));
            cells.push(Cell {
                name: contender.name.clone(),
                style,
                size,
                figures: FIGURES.map(|figure| of(&|record| (figure.of)(&record.row))),
                on_front: [false; 3],
                ms: of(&|record| record.row.total_ms),
                spread_ms: of(&|record| 0.5 * (record.quartiles[1] - record.quartiles[0])),
                bytes: records.iter().map(|record| record.row.bytes).max().unwrap_or(0),
                cases: records.len(),
                failed: records.iter().filter(|record| record.row.failed()).count(),
            });
        }
    }
    for figure in 0..FIGURES.len() {
        let points: Vec<[f64; 2]> = cells.iter().map(|cell| [cell.figures[figure], cell.ms]).collect();
        for (cell, on_front) in cells.iter_mut().zip(pareto_front(&points)) {
            cell.on_front[figure] = on_front;
        }
    }
    cells
}
