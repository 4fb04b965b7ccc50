//! The Pareto front of a plot.

use std::fmt::Write as _;

use super::plot::Marks;
use super::plot_marks::Mark;
use crate::lab::statistics::pareto_front;

/// What the rings mean.
pub(super) const WORDS: &str =
    "Ringed and joined: the Pareto front, points that no other one beats in both values; curves without one are pale.";
/// Radius of a ring, CSS pixels: outside of every marker.
const RING: f64 = 7.5;

/// Finds the points that no other one beats.
pub(super) fn mark(marks: &mut Marks) {
    let all: Vec<&mut Mark> = marks.series.iter_mut().flatten().collect();
    let values: Vec<[f64; 2]> = all.iter().map(|mark| mark.values).collect();
    for (mark, on_front) in all.into_iter().zip(pareto_front(&values)) {
        mark.on_front = on_front;
    }
}

/// Rings them, and joins them behind the curves.
pub(super) fn draw(body: &mut String, marks: &Marks) {
    let mut front: Vec<&Mark> = marks.series.iter().flatten().filter(|mark| mark.on_front).collect();
    front.sort_by(|a, b| a.values[0].total_cmp(&b.values[0]));
    let points: Vec<String> = front.iter().map(|mark| format!("{},{}", mark.at[0], mark.at[1])).collect();
    let _ = writeln!(body, "<g class=\"front\"><polyline points=\"{}\"/>", points.join(" "));
    for mark in front {
        let _ = writeln!(body, "<circle cx=\"{}\" cy=\"{}\" r=\"{RING}\"/>", mark.at[0], mark.at[1]);
    }
    body.push_str("</g>\n");
}

#[cfg(test)]
mod tests {
    use crate::lab::report::{Axes, PlotPoint, Series, error_time_svg};

    #[test]
    fn the_front_is_ringed_and_the_rest_steps_back() {
        let series = |name: &str, points: &[(f64, f64)]| {
            let point = |&(x, y): &(f64, f64)| PlotPoint { x, y, label: "512".into() };
            Series { name: name.into(), style: 0, points: points.iter().map(point).collect() }
        };
        let all = [
            series("worse", &[(0.5, 9.0)]),
            series("good", &[(0.4, 1.0), (0.1, 3.0)]),
            series("failed", &[(f64::NAN, 0.1)]),
            series("best", &[(0.05, 8.0), (0.2, 8.0)]),
        ];
        let svg = error_time_svg("t", &all, &Axes { front: true, ..Axes::default() });
        roxmltree::Document::parse(&svg).unwrap();
        assert_eq!(svg.matches("<circle").count(), 3);
        assert_eq!(svg.matches("s c0 back").count(), 2);
        assert!(svg.contains("Ringed") && svg.contains("Not drawn, no figure (NaN): failed 512"));
        // Pale curves lie behind those of the front.
        assert!(svg.rfind("s c0 back").unwrap() < svg.find("<title>good").unwrap());
        assert!(!error_time_svg("t", &all, &Axes::default()).contains("<circle"));
    }
}
