//! Error–time curves as SVG: both axes logarithmic, one curve per technique, one point per map size.
//!
//! The plotting crate lays out the axes and maps values to the picture. Curves, labels and the legend are written here,
//! each curve in a group of its own, so that a page can single one out and every point tells its value when pointed at.
//! The picture carries its own colours for light and dark surroundings and for paper.

use std::error::Error;
use std::fmt::Write as _;
use std::ops::Range;

use plotters::coord::combinators::{BindKeyPoints, IntoLogRange};
use plotters::prelude::{ChartBuilder, IntoDrawingArea, RGBColor, SVGBackend};
use plotters::style::{Color, IntoFont};

use super::html::Escaped;
use super::plot_front;
use super::plot_marks::{self, Mark};
use super::plot_scale::{self, Scale, Ticks};

/// Width of the picture, CSS pixels; text sizes below suit this width.
const WIDTH: u32 = 640;
/// Height of title and axes together, CSS pixels; the legend comes below.
pub(super) const AXES_HEIGHT: u32 = 430;
/// Room above the frame for the title and the name of the upright axis, CSS pixels.
const TOP: u32 = 58;
/// Room left of the frame for its ticks, CSS pixels: enough for `2×10⁻⁵`.
const LEFT: u32 = 62;
/// Room below the frame for ticks and the name of the level axis, CSS pixels.
const BOTTOM: u32 = 52;
/// Room right of the frame, CSS pixels.
const RIGHT: u32 = 18;
/// Size of tick labels, in the units of the plotting crate (1.24 of them are one CSS pixel).
const TICK_FONT: f64 = 14.0;
/// Stands for the colour of the text around the picture until the SVG is complete.
const INK: RGBColor = RGBColor(1, 2, 3);
/// How [`INK`] reads in SVG.
const INK_TEXT: &str = "#010203";
/// Strength of lines through labelled ticks, 0..1: visible, yet behind the curves.
const GRID: f64 = 0.16;
/// Strength of the lines between, 0..1.
const FAINT_GRID: f64 = 0.06;

/// One curve.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Which colour, marker and dash: any number; equal numbers look alike in every plot.
    pub style: usize,
    /// Points in the order the curve joins them.
    pub points: Vec<PlotPoint>,
}

/// One point of a curve.
#[derive(Clone, Debug)]
pub struct PlotPoint {
    /// Value on the level axis. Not finite: the point is listed below the plot; zero or less: it sits on the left edge.
    pub x: f64,
    /// Value on the upright axis, with the same rules.
    pub y: f64,
    /// A short label, such as the map size.
    pub label: String,
}

/// The two axes.
#[derive(Clone, Debug, Default)]
pub struct Axes {
    /// Level axis: the error.
    pub x: Axis,
    /// Upright axis: the time.
    pub y: Axis,
    /// Whether the Pareto front is marked, the points that no other one beats in both values; curves that are nowhere
    /// on it step back.
    pub front: bool,
}

/// One axis, logarithmic.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// Metric and unit.
    pub name: String,
    /// A value to mark with a line across the plot.
    pub floor: Option<Floor>,
    /// For values of either sign: linear up to about this distance from zero (> 0), logarithmic beyond it on both sides.
    pub linear: Option<f64>,
}

impl Axis {
    /// A number whose logarithm is where a value stands; not positive where there is no place for it.
    pub(super) fn place(&self, value: f64) -> f64 {
        self.linear.map_or(value, |linear| (value / linear).asinh().exp())
    }

    fn scale(&self, range: &Range<f64>) -> Scale {
        self.linear.map_or_else(|| Scale::over(range.clone()), |linear| Scale::signed(range.clone(), linear))
    }
}

/// A marked value of an axis: what no unfiltered technique can pass, or a budget.
#[derive(Clone, Debug)]
pub struct Floor {
    /// Value on the axis; drawn when positive and finite.
    pub value: f64,
    /// What it is.
    pub label: String,
}

/// The frame that curves are drawn in, in whole pixels of the picture.
pub(super) struct Frame {
    /// Left to right.
    pub(super) x: Range<i32>,
    /// Top to bottom.
    pub(super) y: Range<i32>,
}

impl Frame {
    /// Where a point stands, pixels; both values are positive.
    pub(super) fn at(&self, [x_scale, y_scale]: [&Scale; 2], [x, y]: [f64; 2]) -> [f64; 2] {
        let along =
            |range: &Range<i32>, share: f64| f64::from(range.start) + share * f64::from(range.end - range.start);
        [along(&self.x, x_scale.share(x)), along(&self.y, 1.0 - y_scale.share(y))]
    }
}

/// Draws the curves as one SVG document.
///
/// Nothing is dropped: points without a figure are listed below the plot, points at zero sit on its edge and are
/// counted, and a plot without any figure says so.
#[must_use]
pub fn error_time_svg(title: &str, series: &[Series], axes: &Axes) -> String {
    // Find the ranges of the values that can be drawn.
    let drawable = |point: &&PlotPoint| point.x.is_finite() && point.y.is_finite();
    let points = || series.iter().flat_map(|s| &s.points).filter(drawable);
    let floor = |axis: &Axis| axis.floor.as_ref().map(|floor| axis.place(floor.value));
    let x_range = plot_scale::range(points().map(|p| axes.x.place(p.x)).chain(floor(&axes.x)));
    let y_range = plot_scale::range(points().map(|p| axes.y.place(p.y)).chain(floor(&axes.y)));
    // Let the plotting crate draw the axes and place every point.
    let empty = points().next().is_none();
    let (mut body, frame, mut marks) = match draw_axes(series, axes, &x_range, &y_range, empty) {
        Ok(drawn) => drawn,
        Err(error) => return document(title, &plot_marks::apology(&error), f64::from(AXES_HEIGHT)),
    };
    // Write what it has no words for: names, curves, legend.
    name_axes(&mut body, title, [&axes.x.name, &axes.y.name], &frame);
    if empty {
        plot_marks::no_data(&mut body, &frame);
    }
    if axes.front {
        plot_front::mark(&mut marks);
        plot_front::draw(&mut body, &marks);
    }
    let taken = plot_marks::floors(&mut body, &marks, axes, &frame);
    let bottom = plot_marks::curves(&mut body, series, &marks, &frame, taken, f64::from(AXES_HEIGHT));
    let height = plot_marks::notes(&mut body, series, axes, f64::from(WIDTH), bottom);
    document(title, &body, height)
}

/// Where everything stands, in pixels of the picture.
pub(super) struct Marks {
    /// Points of each series that can be drawn.
    pub(super) series: Vec<Vec<Mark>>,
    /// Whether there is a front for them to be on.
    pub(super) front: bool,
    /// Line of the level axis' floor, from top to bottom.
    pub(super) x_floor: Option<[(i32, i32); 2]>,
    /// Line of the upright axis' floor, from left to right.
    pub(super) y_floor: Option<[(i32, i32); 2]>,
}

/// Draws frame, grid and ticks, and maps the data into them.
fn draw_axes(
    series: &[Series],
    axes: &Axes,
    x_range: &Range<f64>,
    y_range: &Range<f64>,
    empty: bool,
) -> Result<(String, Frame, Marks), Box<dyn Error>> {
    let (mut x, mut y) = (axes.x.scale(x_range), axes.y.scale(y_range));
    if empty {
        // Axes without data get no ticks: any number there would be made up.
        x.ticks = Ticks { labelled: vec![], faint: vec![] };
        y.ticks = Ticks { labelled: vec![], faint: vec![] };
    }
    let (body, frame) = mesh(&x, &y)?;
    // Map every point that has a place; what a logarithm cannot show sits on the edge.
    let at = |level: f64, upright: f64| {
        let within = |scale: &Scale, value: f64| value.clamp(scale.range.start, scale.range.end);
        let [x, y] = frame.at([&x, &y], [within(&x, level), within(&y, upright)]);
        (x.round() as i32, y.round() as i32)
    };
    let marked = |axis: &Axis| axis.floor.as_ref().map(|f| axis.place(f.value)).filter(|v| v.is_finite() && *v > 0.0);
    let mark = |point: &PlotPoint| Mark::new(point, [axes.x.place(point.x), axes.y.place(point.y)], at);
    let marks = Marks {
        series: series.iter().map(|s| s.points.iter().filter_map(mark).collect()).collect(),
        front: axes.front,
        x_floor: marked(&axes.x).map(|v| [at(v, y_range.start), at(v, y_range.end)]),
        y_floor: marked(&axes.y).map(|v| [at(x_range.start, v), at(x_range.end, v)]),
    };
    Ok((body, frame, marks))
}

/// Lets the plotting crate draw frame, grid and ticks of two axes.
pub(super) fn mesh(x: &Scale, y: &Scale) -> Result<(String, Frame), Box<dyn Error>> {
    let mut svg = String::new();
    let area = SVGBackend::with_string(&mut svg, (WIDTH, AXES_HEIGHT)).into_drawing_area();
    let axis = |scale: &Scale| {
        let (range, ticks) = (scale.range.clone(), &scale.ticks);
        range.log_scale().with_key_points(ticks.labelled.clone()).with_light_points(ticks.faint.clone())
    };
    let mut chart = ChartBuilder::on(&area)
        .margin_top(TOP)
        .margin_right(RIGHT)
        .x_label_area_size(BOTTOM)
        .y_label_area_size(LEFT)
        .build_cartesian_2d(axis(x), axis(y))?;
    chart
        .configure_mesh()
        .axis_style(INK.mix(0.55))
        .bold_line_style(INK.mix(GRID))
        .light_line_style(INK.mix(FAINT_GRID))
        .x_label_formatter(&|tick| x.says(*tick))
        .y_label_formatter(&|tick| y.says(*tick))
        .label_style(("sans-serif", TICK_FONT).into_font().color(&INK))
        .draw()?;
    let (x_pixels, y_pixels) = chart.plotting_area().get_pixel_range();
    drop(chart);
    drop(area);
    // Keep what is between the document's tags, in the colour of the text around it.
    let body = svg.split_once('\n').map_or("", |(_, body)| body).trim_end().trim_end_matches("</svg>");
    Ok((body.replace(INK_TEXT, "currentColor"), Frame { x: x_pixels, y: y_pixels }))
}

/// Writes the title and the axes' names, all of them level, as nobody likes to tilt their head.
pub(super) fn name_axes(body: &mut String, title: &str, [x, y]: [&str; 2], frame: &Frame) {
    let _ = write!(
        body,
        "<text class=\"title\" x=\"2\" y=\"17\">{}</text>\n\
         <text class=\"axis\" x=\"2\" y=\"{}\">↑ {}</text>\n\
         <text class=\"axis\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{} →</text>\n",
        Escaped(title),
        frame.y.start - 16,
        Escaped(y),
        frame.x.end,
        frame.y.end + 42,
        Escaped(x),
    );
}

/// Wraps the body into a document with its own colours.
pub(super) fn document(title: &str, body: &str, height: f64) -> String {
    let style = include_str!("plot.css");
    format!(
        "<svg class=\"error-time\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" \
         width=\"{WIDTH}\" height=\"{height:.0}\" role=\"img\" aria-label=\"{}\">\n<style>\n{style}</style>\n{body}</svg>\n",
        Escaped(title),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(name: &str, points: &[(f64, f64)]) -> Series {
        let point = |(i, &(x, y)): (usize, &(f64, f64))| PlotPoint { x, y, label: (512 << i).to_string() };
        Series { name: name.into(), style: 0, points: points.iter().enumerate().map(point).collect() }
    }

    fn axes(floor: f64) -> Axes {
        let axis = |name: &str, value| Axis {
            name: name.into(),
            floor: Some(Floor { value, label: "<floor>".into() }),
            ..Axis::default()
        };
        Axes { x: axis("error & more", floor), y: axis("time, ms", floor), front: false }
    }

    /// Draws, reads the result as XML, and returns how many markers have a place on the axes.
    fn markers(series: &[Series], floor: f64) -> (usize, String) {
        let svg = error_time_svg("a <title>", series, &axes(floor));
        let document = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{error}\n{svg}"));
        assert!(!svg.contains("NaN,") && !svg.contains("inf") && !svg.contains("-2147483648"), "{svg}");
        assert!(!svg.contains(INK_TEXT), "the stand-in colour shows");
        let told =
            |node: &roxmltree::Node| node.has_tag_name("path") && node.children().any(|c| c.has_tag_name("title"));
        (document.descendants().filter(told).count(), svg)
    }

    #[test]
    fn every_point_has_a_marker_and_every_series_a_name() {
        let (count, svg) = markers(&[series("ssm", &[(0.1, 3.0), (0.05, 5.0)]), series("a<b>", &[(0.02, 9.0)])], 0.01);
        assert_eq!(count, 3);
        assert!(svg.contains(">ssm</text>") && svg.contains(">a&lt;b&gt;</text>") && svg.contains(">1024</text>"));
        assert_eq!(svg.matches("class=\"floor\"").count(), 2);
        assert!(!svg.contains("no data") && !svg.contains("Not drawn"));
    }

    #[test]
    fn what_cannot_be_drawn_is_said() {
        let points = [(f64::NAN, 1.0), (0.1, f64::INFINITY), (0.0, 2.0), (0.1, 2.0)];
        let (count, svg) = markers(&[series("psm", &points)], f64::NAN);
        assert_eq!(count, 2);
        assert!(svg.contains("Not drawn, no figure (NaN): psm 512, psm 1024"));
        assert!(svg.contains("At zero, drawn hollow on the edge: psm 2048") && svg.contains("m edge"));
        assert_eq!(svg.matches("class=\"floor\"").count(), 0);
    }

    #[test]
    fn nothing_to_show_is_said() {
        for nothing in [vec![], vec![series("ssm", &[])], vec![series("ssm", &[(f64::NAN, f64::NAN)])]] {
            let (count, svg) = markers(&nothing, f64::NAN);
            assert_eq!(count, 0);
            assert!(svg.contains("no data"), "{svg}");
        }
    }

    #[test]
    fn values_of_either_sign_have_a_place() {
        let points = [(-0.05, 1.0), (0.0, 2.0), (0.05, 3.0), (5.0, 4.0)];
        let x = Axis { name: "excess".into(), linear: Some(0.01), ..Axis::default() };
        let svg = error_time_svg("t", &[series("ssm", &points)], &Axes { x, ..Axes::default() });
        assert!(!svg.contains("At zero") && !svg.contains("m edge"), "{svg}");
        for tick in ["\n-0.05\n", "\n0\n", "\n0.05\n", "\n5\n"] {
            assert!(svg.contains(tick), "{tick} is not on the axis:\n{svg}");
        }
        // Zero is in the middle between a value and its opposite.
        let line = svg.split("class=\"line\"").nth(1).and_then(|rest| rest.split("points=\"").nth(1)).unwrap();
        let x = |nth: usize| line.split(' ').nth(nth).unwrap().split(',').next().unwrap().parse::<f64>().unwrap();
        assert!((x(0) + x(2) - 2.0 * x(1)).abs() <= 2.0 && x(3) > x(2) + 20.0, "{line}");
    }

    #[test]
    fn extremes_stay_on_the_picture() {
        let cases = [(0.0, 0.0), (-1.0, 5.0), (f64::MIN_POSITIVE, f64::MAX), (1e300, 1e-300), (7.0, 7.0)];
        for single in cases {
            assert_eq!(markers(&[series("one", &[single])], 0.5).0, 1, "{single:?}");
        }
        let (count, svg) = markers(&[series("all", &cases)], 1e-9);
        assert_eq!(count, cases.len());
        // Every marker lies within the picture.
        for path in svg.split("class=\"m").skip(1).filter_map(|text| text.split_once("d=\"M")) {
            let mut numbers =
                path.1.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).map(str::parse::<f64>);
            let (x, y) = (numbers.next().unwrap().unwrap(), numbers.next().unwrap().unwrap());
            assert!((0.0..f64::from(WIDTH)).contains(&x) && (0.0..600.0).contains(&y), "{x} {y}");
        }
    }

    #[test]
    fn many_curves_grow_the_legend_not_the_axes() {
        let many: Vec<_> = (0..60).map(|i| series(&format!("a technique named {i}"), &[(0.1, 1.0)])).collect();
        let (count, svg) = markers(&many, 0.05);
        assert_eq!(count, 60);
        let height = svg.split_once("height=\"").and_then(|(_, rest)| rest.split('"').next()).unwrap();
        assert!(height.parse::<f64>().unwrap() > f64::from(AXES_HEIGHT) + 200.0);
    }
}
