//! Error–time curves.

use antumbra::lab::report::{Axes, Axis, PlotPoint, Series, error_time_svg};

use crate::summary::{Cell, FIGURES, Figure};

/// File name of a plot.
pub(crate) fn file(set: &str, figure: &Figure) -> String {
    format!("work_precision-{set}-{}.svg", figure.name)
}

/// One plot per figure, by file name: a curve per contender, a point per size.
pub(crate) fn plots(set: &str, cells: &[Cell]) -> Vec<(String, String)> {
    let plot = |(index, figure): (usize, &Figure)| {
        let mut series: Vec<Series> = Vec::new();
        for cell in cells {
            let point = PlotPoint { x: cell.figures[index], y: cell.ms, label: cell.size.to_string() };
            match series.iter_mut().find(|series| series.name == cell.name) {
                Some(series) => series.points.push(point),
                None => series.push(Series { name: cell.name.clone(), style: cell.style, points: vec![point] }),
            }
        }
        let x = Axis { name: figure.axis.to_owned(), linear: figure.linear, ..Axis::default() };
        let y = Axis { name: "time of a frame, ms".to_owned(), ..Axis::default() };
        let title = format!("{set}: {} and time, medians over cases", figure.name);
        (file(set, figure), error_time_svg(&title, &series, &Axes { x, y, front: true }))
    };
    FIGURES.iter().enumerate().map(plot).collect()
}
