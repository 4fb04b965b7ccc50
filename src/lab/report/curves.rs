//! The plots of one scene: which rows make which curve.

use std::io::{self, Write};

use super::column::{self, Cell, KIB};
use super::plot::{Axes, Axis, Floor, PlotPoint, Series, error_time_svg};
use super::{Report, Row, SceneSection};

/// One plot of a scene: its title, and for each axis the column and the name.
struct Plot {
    title: &'static str,
    x: &'static str,
    x_name: &'static str,
    y: &'static str,
    y_name: &'static str,
    has_floor: bool,
}

/// The plots, in order.
const PLOTS: [Plot; 4] = [
    Plot {
        title: "Picture error and time",
        x: "mae",
        x_name: "mean absolute error against the area truth",
        y: "total_ms",
        y_name: "time of a frame, ms",
        has_floor: true,
    },
    Plot {
        title: "Wrong pixels and time",
        x: "wrong_center",
        x_name: "pixels wrong against the centre truth, %",
        y: "total_ms",
        y_name: "time of a frame, ms",
        has_floor: false,
    },
    Plot {
        title: "Picture error and memory",
        x: "mae",
        x_name: "mean absolute error against the area truth",
        y: "bytes",
        y_name: "map memory, MiB",
        has_floor: true,
    },
    Plot {
        title: "Prediction and outcome",
        x: "predicted_px",
        x_name: "predicted footprint, px per texel",
        y: "edge_center_px",
        y_name: "measured shift of shadow edges, px",
        has_floor: false,
    },
];

/// Techniques in order of appearance: the place in this list decides colour and marker all over the page.
pub(super) fn technique_order(report: &Report) -> Vec<&str> {
    let mut order: Vec<&str> = Vec::new();
    for row in report.rows() {
        if !order.contains(&row.technique.as_str()) {
            order.push(&row.technique);
        }
    }
    order
}

/// Writes the plots of a scene.
pub(super) fn write(sink: &mut impl Write, section: &SceneSection, styles: &[&str]) -> io::Result<()> {
    if section.rows.is_empty() {
        return Ok(());
    }
    writeln!(
        sink,
        "<h3>Error against cost</h3>\n<p class=\"hint\">Both axes are logarithmic; lower left is better. One curve per \
         technique, one point per map size (texels a side). Point at a curve or its name to single it out.</p>\n\
         <div class=\"plots\">"
    )?;
    for plot in &PLOTS {
        // Inside a page the document's namespace is understood.
        let svg = svg(plot, &section.rows, styles).replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
        writeln!(sink, "<figure class=\"plot\">{svg}</figure>")?;
    }
    writeln!(sink, "</div>")
}

/// A row's value in the unit of the axis; NaN when the column holds none.
fn value(name: &str, row: &Row) -> f64 {
    match column::find(name).map(|column| (column.cell)(row)) {
        Some(cell @ Cell::Bytes(_)) => cell.number().map(|bytes| bytes / (KIB * KIB)),
        Some(Cell::Share(share)) => Some(100.0 * share),
        other => other.and_then(|cell| cell.number()),
    }
    .unwrap_or(f64::NAN)
}

/// Draws one plot.
fn svg(plot: &Plot, rows: &[Row], styles: &[&str]) -> String {
    let point = |row: &Row| {
        let missing = row.failed();
        let at = |name| if missing { f64::NAN } else { value(name, row) };
        PlotPoint { x: at(plot.x), y: at(plot.y), label: row.size.to_string() }
    };
    // Gather each technique's points in order of map size; more than one backend makes more than one curve.
    let several_backends = rows.iter().any(|row| row.backend != rows[0].backend);
    let name = |row: &Row| {
        if several_backends { format!("{} ({})", row.technique, row.backend) } else { row.technique.clone() }
    };
    let mut ordered: Vec<&Row> = rows.iter().collect();
    ordered.sort_by_key(|row| row.size);
    let mut series: Vec<Series> = Vec::new();
    for row in rows {
        if series.iter().any(|s| s.name == name(row)) {
            continue;
        }
        let style = styles.iter().position(|&style| style == row.technique).unwrap_or_default();
        let points = ordered.iter().filter(|other| name(other) == name(row)).map(|row| point(row)).collect();
        series.push(Series { name: name(row), style, points });
    }
    // Mark what a perfect lookup with one sample would score.
    let floor = rows.iter().map(|row| row.floor_mae).find(|floor| floor.is_finite()).filter(|_| plot.has_floor);
    let x_floor = floor.map(|value| Floor { value, label: "floor: one perfect sample per pixel".into() });
    let x = Axis { name: plot.x_name.into(), floor: x_floor, linear: None };
    error_time_svg(
        plot.title,
        &series,
        &Axes { x, y: Axis { name: plot.y_name.into(), ..Axis::default() }, front: false },
    )
}
