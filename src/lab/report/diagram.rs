//! Diagrams of lines and spots over two logarithmic axes, in the style of the error–time curves.

use std::fmt::Write as _;

use super::html::Escaped;
use super::plot::{self, AXES_HEIGHT, Frame};
use super::plot_marks::{self, COLOURS, marker};
use super::plot_scale::{self, Scale};

/// Length of the sample line of a legend, CSS pixels.
const SAMPLE: f64 = 24.0;
/// Gap between a spot and its label, CSS pixels.
const GAP: f64 = 8.0;
/// From a label's middle to its base line, CSS pixels.
const BASE: f64 = 3.5;

/// Lines and spots over two logarithmic axes.
#[derive(Clone, Debug, Default)]
pub struct Diagram {
    /// Headline.
    pub title: String,
    /// Name of the level axis.
    pub x_name: String,
    /// Name of the upright axis.
    pub y_name: String,
    /// Labelled ticks of the level axis; none: powers of ten and what people read between them.
    pub x_ticks: Vec<Tick>,
    /// What is drawn, from back to front.
    pub layers: Vec<Layer>,
}

/// A labelled tick.
#[derive(Clone, Debug)]
pub struct Tick {
    /// Where on the axis, > 0.
    pub at: f64,
    /// What it says.
    pub says: String,
}

/// Lines and spots that belong together: one colour, one line of the legend.
#[derive(Clone, Debug, Default)]
pub struct Layer {
    /// Name in the legend; empty: not in the legend.
    pub name: String,
    /// Which colour and marker: any number.
    pub style: usize,
    /// How its lines look.
    pub look: Look,
    /// Lines, each through its points [x, y]. Points that are not positive and finite interrupt a line.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// Marked points, drawn over the lines.
    pub spots: Vec<Spot>,
}

/// How lines look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// One of a few.
    #[default]
    Curve,
    /// One of very many: thin and half transparent.
    Thin,
    /// Something to compare with: dashed, in the colour of the text. It does not widen the axes.
    Rule,
}

/// A marked point.
#[derive(Clone, Debug, Default)]
pub struct Spot {
    /// Its place [x, y]; not drawn where that is not positive and finite.
    pub at: [f64; 2],
    /// What is written beside it; may be empty.
    pub label: String,
    /// On which side that is: left (−1) to right (1), below (−1) to above (1).
    pub side: [i8; 2],
    /// What it tells when pointed at; may be empty.
    pub told: String,
}

/// Draws a diagram as one SVG document. Without a point that can be drawn it says so.
#[must_use]
pub fn diagram_svg(diagram: &Diagram) -> String {
    // Lay out the axes around what is drawn.
    let [x, y] = [0, 1].map(|side| Scale::over(plot_scale::range(values(diagram, side))));
    let x = with_ticks(x, &diagram.x_ticks);
    let height = f64::from(AXES_HEIGHT);
    let (mut body, frame) = match plot::mesh(&x, &y) {
        Ok(drawn) => drawn,
        Err(error) => return plot::document(&diagram.title, &plot_marks::apology(&error), height),
    };
    plot::name_axes(&mut body, &diagram.title, [&diagram.x_name, &diagram.y_name], &frame);
    if values(diagram, 0).next().is_none() {
        plot_marks::no_data(&mut body, &frame);
    }
    // Draw the layers, cut at the frame, each with its line of the legend.
    clip(&mut body, &frame);
    let names: Vec<&str> =
        diagram.layers.iter().map(|layer| layer.name.as_str()).filter(|name| !name.is_empty()).collect();
    let (places, end) = plot_marks::legend_places(&names, &frame, height);
    let mut places = places.into_iter();
    for layer in &diagram.layers {
        let _ = writeln!(body, "<g class=\"s c{}\"><title>{}</title>", layer.style % COLOURS, Escaped(&layer.name));
        draw(&mut body, layer, [&x, &y], &frame);
        if !layer.name.is_empty()
            && let Some(place) = places.next()
        {
            key(&mut body, layer, place);
        }
        body.push_str("</g>\n");
    }
    plot::document(&diagram.title, &body, end + 8.0)
}

/// The values that widen an axis: 0 the level one, 1 the upright one.
fn values(diagram: &Diagram, side: usize) -> impl Iterator<Item = f64> {
    let widening = diagram.layers.iter().filter(|layer| layer.look != Look::Rule);
    let points =
        widening.flat_map(|layer| layer.lines.iter().flatten().copied().chain(layer.spots.iter().map(|s| s.at)));
    points.filter(drawable).map(move |point| point[side])
}

/// Whether a logarithm can show a point.
fn drawable(point: &[f64; 2]) -> bool {
    point.iter().all(|value| value.is_finite() && *value > 0.0)
}

/// An axis with ticks of its own, those of them that it reaches.
fn with_ticks(mut scale: Scale, ticks: &[Tick]) -> Scale {
    if !ticks.is_empty() {
        scale.words = ticks.iter().map(|tick| (tick.at, tick.says.clone())).collect();
        scale.ticks.labelled = ticks.iter().map(|tick| tick.at).filter(|at| scale.range.contains(at)).collect();
        scale.ticks.faint.clear();
    }
    scale
}

/// Says what lines are cut at.
fn clip(body: &mut String, frame: &Frame) {
    let (x, y) = (&frame.x, &frame.y);
    let _ = writeln!(
        body,
        "<clipPath id=\"frame\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>",
        x.start,
        y.start,
        x.end - x.start,
        y.end - y.start
    );
}

/// Draws a layer's lines, as one path, and its spots.
fn draw(body: &mut String, layer: &Layer, scales: [&Scale; 2], frame: &Frame) {
    let mut path = String::new();
    for line in &layer.lines {
        let mut command = 'M';
        for point in line {
            if !drawable(point) {
                command = 'M';
                continue;
            }
            let [x, y] = frame.at(scales, *point);
            let _ = write!(path, "{command}{x:.1} {y:.1}");
            command = 'L';
        }
    }
    if !path.is_empty() {
        let _ = writeln!(body, "<path class=\"{}\" clip-path=\"url(#frame)\" d=\"{path}\"/>", class(layer.look));
    }
    for spot in layer.spots.iter().filter(|spot| drawable(&spot.at)) {
        let [x, y] = frame.at(scales, spot.at);
        let told = Escaped(&spot.told);
        let _ = writeln!(body, "<path class=\"m\" d=\"{}\"><title>{told}</title></path>", outline(layer.style, x, y));
        if !spot.label.is_empty() {
            label(body, spot, [x, y]);
        }
    }
}

/// The outline of a marker, to a tenth of a pixel.
fn outline(style: usize, x: f64, y: f64) -> String {
    let tenth = |value: f64| (value * 10.0).round() / 10.0;
    marker(style, tenth(x), tenth(y))
}

fn class(look: Look) -> &'static str {
    match look {
        Look::Curve => "line",
        Look::Thin => "thin",
        Look::Rule => "rule",
    }
}

/// Writes a spot's label on its side.
fn label(body: &mut String, spot: &Spot, [x, y]: [f64; 2]) {
    let [right, above] = spot.side.map(f64::from);
    let anchor = match spot.side[0] {
        ..0 => "end",
        0 => "middle",
        _ => "start",
    };
    // Beside a corner, half the gap each way is far enough.
    let gap = if right != 0.0 && above != 0.0 { GAP * 0.75 } else { GAP };
    let (x, y) = (x + right * gap, y - above * (gap + BASE) + BASE);
    let _ = writeln!(
        body,
        "<text class=\"p\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>",
        Escaped(&spot.label)
    );
}

/// Draws a layer's line of the legend.
fn key(body: &mut String, layer: &Layer, (x, y): (f64, f64)) {
    if !layer.lines.is_empty() {
        // A sample of a thin line would hardly be seen.
        let look = if layer.look == Look::Thin { Look::Curve } else { layer.look };
        let _ = write!(body, "<path class=\"{}\" d=\"M{x:.0} {y:.0}h{SAMPLE}\"/>", class(look));
    }
    if !layer.spots.is_empty() {
        let _ = write!(body, "<path class=\"m\" d=\"{}\"/>", outline(layer.style, x + SAMPLE / 2.0, y));
    }
    let name = Escaped(&layer.name);
    let _ = writeln!(body, "<text class=\"key\" x=\"{:.0}\" y=\"{:.0}\">{name}</text>", x + SAMPLE + 6.0, y + 4.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagram(layers: Vec<Layer>) -> Diagram {
        let ticks = [(1.0, "none"), (10.0, "nine")].map(|(at, says)| Tick { at, says: says.into() });
        Diagram {
            title: "a <title>".into(),
            x_name: "x & more".into(),
            y_name: "y".into(),
            x_ticks: ticks.into(),
            layers,
        }
    }

    fn drawn(layers: Vec<Layer>) -> String {
        let svg = diagram_svg(&diagram(layers));
        roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{error}\n{svg}"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        svg
    }

    #[test]
    fn lines_spots_and_names_are_drawn() {
        let spot = Spot { at: [2.0, 3.0], label: "<here>".into(), side: [1, 1], told: "x = 2".into() };
        let line = vec![[1.0, 1.0], [3.0, 4.0], [f64::NAN, 1.0], [5.0, 0.5], [20.0, 1.0]];
        let layer = Layer { name: "one & only".into(), lines: vec![line], spots: vec![spot], ..Layer::default() };
        let rule = Layer { look: Look::Rule, lines: vec![vec![[1e-9, 1.0], [1e9, 1.0]]], ..Layer::default() };
        let svg = drawn(vec![rule, layer]);
        assert!(svg.contains("&lt;here&gt;") && svg.contains("one &amp; only") && svg.contains("\nnine\n"));
        // Two strokes of the interrupted line, one marker on the plot and one in the legend.
        let path = svg.split("class=\"line\"").nth(1).and_then(|rest| rest.split("d=\"").nth(1)).unwrap();
        assert_eq!(path.split('"').next().unwrap().matches('M').count(), 2);
        assert_eq!(svg.matches("class=\"m\"").count(), 2);
        // The rule is as wide as the frame, and the frame is not as wide as the rule.
        assert!(svg.contains("\nnone\n"));
    }

    #[test]
    fn a_line_that_leaves_the_frame_keeps_its_slope() {
        let spot = |at: [f64; 2]| Spot { at, ..Spot::default() };
        let inside = Layer { spots: vec![spot([1.0, 1.0]), spot([10.0, 1000.0])], ..Layer::default() };
        let rule =
            Layer { look: Look::Rule, lines: vec![vec![[1e-3, 1e-3], [1.0, 1.0], [1e6, 1e6]]], ..inside.clone() };
        let svg = drawn(vec![inside, rule]);
        let path = svg.split("class=\"rule\"").nth(1).and_then(|rest| rest.split("d=\"M").nth(1)).unwrap();
        let numbers = path.split('"').next().unwrap().split(['L', ' ']).map(|number| number.parse::<f64>().unwrap());
        let [x0, y0, x1, y1, x2, y2] = *numbers.collect::<Vec<_>>() else { panic!("{path}") };
        assert!(((y1 - y0) / (x1 - x0) - (y2 - y1) / (x2 - x1)).abs() < 1e-3, "{path}");
        assert!(x0 < 0.0 && y2 < 0.0, "{path}");
    }

    #[test]
    fn nothing_to_show_is_said() {
        let empty = Layer { lines: vec![vec![[f64::NAN, 1.0], [0.0, 2.0]]], ..Layer::default() };
        for layers in [vec![], vec![Layer::default()], vec![empty]] {
            assert!(drawn(layers).contains("no data"));
        }
    }
}
