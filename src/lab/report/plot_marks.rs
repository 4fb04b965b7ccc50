//! Curves, point labels, legend and notes of a plot, as SVG text.

use std::fmt::{Display, Write as _};

use super::html::Escaped;
use super::plot::{Axes, Frame, Marks, PlotPoint, Series};
use super::plot_front;

/// Colours in `plot.css`, told apart by people who confuse red and green.
pub(super) const COLOURS: usize = 8;
/// Half the width of a marker, CSS pixels.
const MARKER: f64 = 4.0;
/// Width of a letter of a point label, CSS pixels: an estimate, as the reader's font is not known here.
const LABEL_LETTER: f64 = 5.8;
/// Height of a point label, CSS pixels.
const LABEL_HEIGHT: f64 = 9.0;
/// Gap between a floor's line and its name, CSS pixels.
const FLOOR_GAP: f64 = 6.0;
/// Width of a letter of the legend, CSS pixels, with the same caution.
const LEGEND_LETTER: f64 = 7.0;
/// Width of the sample line in the legend with its gaps, CSS pixels.
const LEGEND_SAMPLE: f64 = 44.0;
/// Distance of legend lines, CSS pixels.
const LEGEND_LINE: f64 = 19.0;
/// Distance of note lines, CSS pixels.
const NOTE_LINE: f64 = 15.0;
/// Width of a letter of a note, CSS pixels.
const NOTE_LETTER: f64 = 6.0;
/// Dash patterns; the first is solid. With five markers,
/// eight colours and three dashes no two of 120 curves look alike.
const DASHES: [&str; 3] = ["none", "7 3", "2 3"];
/// Different markers.
const SHAPES: usize = 5;

/// A point with its place in the picture.
pub(super) struct Mark {
    /// Where it stands, pixels.
    pub(super) at: [f64; 2],
    /// What it stands for.
    pub(super) values: [f64; 2],
    /// Whether no other point beats it.
    pub(super) on_front: bool,
    label: String,
    told: String,
    on_edge: bool,
}

impl Mark {
    /// Puts a point where its axes place it; `None` when one of its values is not a number.
    pub(super) fn new(point: &PlotPoint, places: [f64; 2], at: impl Fn(f64, f64) -> (i32, i32)) -> Option<Self> {
        if !point.x.is_finite() || !point.y.is_finite() {
            return None;
        }
        let (x, y) = at(places[0], places[1]);
        let told = format!("{}: {:.3e}, {:.3e}", point.label, point.x, point.y);
        let on_edge = places.iter().any(|place| *place <= 0.0);
        let (at, values) = ([x.into(), y.into()], [point.x, point.y]);
        Some(Self { at, values, on_front: false, label: point.label.clone(), told, on_edge })
    }
}

/// A rectangle that a label must not cover: left, top, right, bottom.
pub(super) type Taken = [f64; 4];

/// Says in the frame that there is nothing to show.
pub(super) fn no_data(body: &mut String, frame: &Frame) {
    let (x, y) = (i32::midpoint(frame.x.start, frame.x.end), i32::midpoint(frame.y.start, frame.y.end));
    let _ = writeln!(
        body,
        "<text class=\"empty\" x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">no data: no run has both figures</text>"
    );
}

/// Stands in for a plot that the plotting crate refused.
pub(super) fn apology(error: &dyn Display) -> String {
    format!("<text x=\"2\" y=\"40\">This plot could not be drawn: {}</text>\n", Escaped(&error.to_string()))
}

/// Draws the floors as dashed lines across the frame, each with its name on the roomier side;
/// returns the names' places.
pub(super) fn floors(body: &mut String, marks: &Marks, axes: &Axes, frame: &Frame) -> Vec<Taken> {
    let (left, right) = (f64::from(frame.x.start), f64::from(frame.x.end));
    let mut taken = Vec::new();
    let mut draw = |[(x1, y1), (x2, y2)]: [(i32, i32); 2], x: f64, y: f64, label: &str| {
        // Let the name run towards the side that has more room.
        let width = LABEL_LETTER * count(label.chars().count());
        let (anchor, start) = if x < f64::midpoint(left, right) { ("start", x) } else { ("end", x - width) };
        taken.push([start, y - LABEL_HEIGHT, start + width, y]);
        let _ = writeln!(
            body,
            "<g class=\"floor\"><line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>\
             <text x=\"{x:.0}\" y=\"{y:.0}\" text-anchor=\"{anchor}\">{}</text></g>",
            Escaped(label)
        );
    };
    if let (Some(line), Some(floor)) = (marks.x_floor, &axes.x.floor) {
        let x = f64::from(line[0].0);
        let gap = if x < f64::midpoint(left, right) { FLOOR_GAP } else { -FLOOR_GAP };
        draw(line, x + gap, f64::from(frame.y.end) - FLOOR_GAP, &floor.label);
    }
    if let (Some(line), Some(floor)) = (marks.y_floor, &axes.y.floor) {
        draw(line, right - FLOOR_GAP, f64::from(line[0].1) - FLOOR_GAP, &floor.label);
    }
    taken
}

/// Draws every curve with its labels and its line of the legend; returns where the legend ends.
pub(super) fn curves(
    body: &mut String,
    series: &[Series],
    marks: &Marks,
    frame: &Frame,
    mut taken: Vec<Taken>,
    top: f64,
) -> f64 {
    let names: Vec<&str> = series.iter().map(|series| series.name.as_str()).collect();
    let (places, end) = legend_places(&names, frame, top);
    // Keep labels off all markers, then off each other.
    taken.extend(marks.series.iter().flatten().map(marker_box));
    // Where there is a front, the rest steps back, behind it.
    let steps_back = |of: &[Mark]| marks.front && !of.iter().any(|mark| mark.on_front);
    let mut order: Vec<_> = series.iter().zip(&marks.series).zip(places).collect();
    order.sort_by_key(|((_, marks), _)| !steps_back(marks));
    for ((series, marks), place) in order {
        let back = if steps_back(marks) { " back" } else { "" };
        let _ =
            writeln!(body, "<g class=\"s c{}{back}\"><title>{}</title>", series.style % COLOURS, Escaped(&series.name));
        curve(body, series.style, marks);
        for mark in marks {
            label(body, mark, frame, &mut taken, !back.is_empty());
        }
        legend(body, series, place);
        body.push_str("</g>\n");
    }
    end
}

/// Lays a legend out in as many columns as its longest name allows: where each line of it stands, and where it ends.
pub(super) fn legend_places(names: &[&str], frame: &Frame, top: f64) -> (Vec<(f64, f64)>, f64) {
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let column_width = LEGEND_SAMPLE + LEGEND_LETTER * count(longest);
    let columns = fitting(f64::from(frame.x.end), column_width);
    let place = |i: usize| (2.0 + count(i % columns) * column_width, top + 8.0 + count(i / columns) * LEGEND_LINE);
    let end = top + count(names.len().div_ceil(columns)) * LEGEND_LINE + 4.0;
    ((0..names.len()).map(place).collect(), end)
}

/// Draws one curve: its line, a wide unseen line that is easier to point at, and its markers.
fn curve(body: &mut String, style: usize, marks: &[Mark]) {
    if marks.len() > 1 {
        let points = marks.iter().fold(String::new(), |mut text, mark| {
            let _ = write!(text, "{},{} ", mark.at[0], mark.at[1]);
            text
        });
        let points = points.trim_end();
        let dash = dash(style);
        let _ = writeln!(
            body,
            "<polyline class=\"hit\" points=\"{points}\"/><polyline class=\"line\" stroke-dasharray=\"{dash}\" points=\"{points}\"/>"
        );
    }
    for mark in marks {
        let class = if mark.on_edge { "m edge" } else { "m" };
        let _ = writeln!(
            body,
            "<path class=\"{class}\" d=\"{}\"><title>{}</title></path>",
            marker(style, mark.at[0], mark.at[1]),
            Escaped(&mark.told)
        );
    }
}

/// Writes a point's label where there is room; where there is none, and where it is hidden, it shows only when the curve
/// is pointed at.
fn label(body: &mut String, mark: &Mark, frame: &Frame, taken: &mut Vec<Taken>, hidden: bool) {
    let width = LABEL_LETTER * count(mark.label.chars().count());
    let inside = |b: &Taken| {
        b[0] >= f64::from(frame.x.start)
            && b[2] <= f64::from(frame.x.end)
            && b[1] >= f64::from(frame.y.start)
            && b[3] <= f64::from(frame.y.end)
    };
    let free =
        |b: &Taken, taken: &[Taken]| taken.iter().all(|t| b[0] > t[2] || b[2] < t[0] || b[1] > t[3] || b[3] < t[1]);
    // Try right above, left above, right below, left below, above, below.
    let gap = MARKER + 2.0;
    let boxes = [
        (gap, -gap),
        (-gap - width, -gap),
        (gap, gap + LABEL_HEIGHT),
        (-gap - width, gap + LABEL_HEIGHT),
        (-width / 2.0, -gap - 2.0),
        (-width / 2.0, gap + LABEL_HEIGHT + 2.0),
    ]
    .map(|(dx, dy)| [mark.at[0] + dx, mark.at[1] + dy - LABEL_HEIGHT, mark.at[0] + dx + width, mark.at[1] + dy]);
    let found = boxes.iter().find(|b| !hidden && inside(b) && free(b, taken));
    let class = if found.is_some() { "p" } else { "p crowded" };
    let place = found.unwrap_or(&boxes[0]);
    if found.is_some() {
        taken.push(*place);
    }
    let _ = writeln!(
        body,
        "<text class=\"{class}\" x=\"{:.0}\" y=\"{:.0}\">{}</text>",
        place[0],
        place[3],
        Escaped(&mark.label)
    );
}

/// Draws one line of the legend.
fn legend(body: &mut String, series: &Series, (x, y): (f64, f64)) {
    let _ = writeln!(
        body,
        "<line class=\"line\" stroke-dasharray=\"{}\" x1=\"{x:.0}\" y1=\"{y:.0}\" x2=\"{:.0}\" y2=\"{y:.0}\"/>\
         <path class=\"m\" d=\"{}\"/><text class=\"key\" x=\"{:.0}\" y=\"{:.0}\">{}</text>",
        dash(series.style),
        x + 24.0,
        marker(series.style, x + 12.0, y),
        x + 30.0,
        y + 4.0,
        Escaped(&series.name)
    );
}

/// Writes below the legend what is not in the plot, and why; returns where the picture ends.
pub(super) fn notes(body: &mut String, series: &[Series], axes: &Axes, width: f64, top: f64) -> f64 {
    let named = |p: &PlotPoint, s: &Series| format!("{} {}", s.name, p.label);
    let all = || series.iter().flat_map(|s| s.points.iter().map(move |p| (p, s)));
    let missing: Vec<_> =
        all().filter(|(p, _)| !p.x.is_finite() || !p.y.is_finite()).map(|(p, s)| named(p, s)).collect();
    let finite = all().filter(|(p, _)| p.x.is_finite() && p.y.is_finite());
    let on_edge = |p: &PlotPoint| axes.x.place(p.x) <= 0.0 || axes.y.place(p.y) <= 0.0;
    let zero: Vec<_> = finite.filter(|(p, _)| on_edge(p)).map(|(p, s)| named(p, s)).collect();
    let front = if axes.front { vec![plot_front::WORDS.to_owned()] } else { Vec::new() };
    let mut y = top;
    for (what, names) in
        [("", front), ("Not drawn, no figure (NaN): ", missing), ("At zero, drawn hollow on the edge: ", zero)]
    {
        if names.is_empty() {
            continue;
        }
        for line in wrap(&format!("{what}{}", names.join(", ")), fitting(width, NOTE_LETTER)) {
            y += NOTE_LINE;
            let _ = writeln!(body, "<text class=\"note\" x=\"2\" y=\"{y:.0}\">{}</text>", Escaped(&line));
        }
    }
    y + 8.0
}

/// Breaks a text at spaces into lines of so many letters.
fn wrap(text: &str, letters: usize) -> Vec<String> {
    text.split(' ').fold(Vec::new(), |mut lines: Vec<String>, word| {
        match lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= letters) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
        lines
    })
}

/// The space that a marker takes.
fn marker_box(mark: &Mark) -> Taken {
    [mark.at[0] - MARKER, mark.at[1] - MARKER, mark.at[0] + MARKER, mark.at[1] + MARKER]
}

/// The outline of a marker: circle, square, triangle, diamond, upturned triangle.
pub(super) fn marker(style: usize, x: f64, y: f64) -> String {
    let r = MARKER;
    match style % SHAPES {
        0 => format!("M{} {y}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0z", x - r, 2.0 * r, -2.0 * r),
        1 => format!("M{} {}h{s}v{s}h-{s}z", x - 0.9 * r, y - 0.9 * r, s = 1.8 * r),
        2 => format!("M{x} {}l{h} {v}h-{w}z", y - 1.2 * r, h = 1.15 * r, v = 2.1 * r, w = 2.3 * r),
        3 => format!("M{x} {}l{d} {d}l-{d} {d}l-{d} -{d}z", y - 1.3 * r, d = 1.3 * r),
        _ => format!("M{x} {}l{h} -{v}h-{w}z", y + 1.2 * r, h = 1.15 * r, v = 2.1 * r, w = 2.3 * r),
    }
}

/// The dashes of a curve: they change after all colours were used.
fn dash(style: usize) -> &'static str {
    DASHES[style / COLOURS % DASHES.len()]
}

/// A small count as a coordinate.
#[expect(clippy::cast_precision_loss, reason = "counts of letters and curves")]
fn count(n: usize) -> f64 {
    n as f64
}

/// How many things of one width fit side by side, at least one.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates; widths are positive")]
fn fitting(width: f64, each: f64) -> usize {
    ((width / each) as usize).max(1)
}
