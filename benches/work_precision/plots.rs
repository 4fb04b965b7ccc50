//! Error–time curves.

use antumbra::lab::report::{Axes, Axis, PlotPoint, Series, error_time_svg};

use crate::summary::{Cell, FIGURES, Figure};

/// File name of a plot: of all curves, or of those alone that reach the Pareto front.
pub(crate) fn file(set: &str, figure: &Figure, front: bool) -> String {
    format!("work_precision-{set}-{}{}.svg", figure.name, if front { "-front" } else { "" })
}

/// Two plots per figure, by file name: all curves, and those that reach the front.
pub(crate) fn plots(set: &str, cells: &[Cell]) -> Vec<(String, String)> {
    let plot = |index: usize, front: bool| {
        let figure = &FIGURES[index];
        let (only, mut series) = (if front { ", techniques on the front" } else { "" }, curves(cells, index));
        if front {
            let reaches = |cell: &Cell, name: &str| cell.name == name && cell.on_front[index];
            series.retain(|series| cells.iter().any(|cell| reaches(cell, &series.name)));
            // Few curves have colours of their own.
            series.iter_mut().enumerate().for_each(|(style, series)| series.style = style);
        }
        let x = Axis { name: figure.axis.to_owned(), linear: figure.linear, ..Axis::default() };
        let y = Axis { name: "time of a frame, ms".to_owned(), ..Axis::default() };
        let title = format!("{set}: {} and time, medians over cases{only}", figure.name);
        (file(set, figure, front), error_time_svg(&title, &series, &Axes { x, y, front: true }))
    };
    (0..FIGURES.len()).flat_map(|index| [plot(index, false), plot(index, true)]).collect()
}

/// A curve per contender, a point per size.
fn curves(cells: &[Cell], index: usize) -> Vec<Series> {
    let mut series: Vec<Series> = Vec::new();
    for cell in cells {
        let point = PlotPoint { x: cell.figures[index], y: cell.ms, label: cell.size.to_string() };
        match series.iter_mut().find(|series| series.name == cell.name) {
            Some(series) => series.points.push(point),
            None => series.push(Series { name: cell.name.clone(), style: cell.style, points: vec![point] }),
        }
    }
    series
}
