//! The three pictures of the page.

use antumbra::lab::depth_error::{Layout, crossing};
use antumbra::lab::report::{Diagram, Layer, Look, Spot, Tick, diagram_svg};

use crate::cells::{Cell, Cells};
use crate::page::SETS;

/// Strengths that the axis of strengths names.
const NAMED_STRENGTHS: [f64; 8] = [0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0];
/// Curves of the sweep that are drawn: more cannot be told apart.
const CURVES: usize = 6;
/// Size of map whose curves are drawn, where it was swept; texels.
const DRAWN_SIZE: u32 = 1024;

/// Wrong pixels over strength, for cases from the one that gains most to the one that gains least.
pub(crate) fn sweep(cells: &Cells) -> String {
    let size = if cells.all.iter().any(|cell| cell.size == DRAWN_SIZE) { DRAWN_SIZE } else { cells.all[0].size };
    let mut ordered: Vec<&Cell> = cells.all.iter().filter(|cell| cell.size == size).collect();
    ordered.sort_by(|a, b| a.of_fsm(a.best()).total_cmp(&b.of_fsm(b.best())));
    let count = CURVES.min(ordered.len());
    let even = |index: usize| ordered[index * (ordered.len() - 1) / (count - 1).max(1)];
    let curve = |style: usize| {
        let cell = even(style);
        let mut line: Vec<[f64; 2]> =
            cell.swept.iter().map(|record| [1.0 + record.applied, cell.of_fsm(record)]).collect();
        // Strengths beyond what a map takes all end at the same one.
        line.dedup_by_key(|point| point[0]);
        let chosen = cell.named("least-error");
        let told = format!("{}: κλ = {:.2}", cell.case, chosen.applied);
        let spot = Spot { at: [1.0 + chosen.applied, cell.of_fsm(chosen)], told, ..Spot::default() };
        Layer { name: cell.case.clone(), style, look: Look::Curve, lines: vec![line], spots: vec![spot] }
    };
    let rule = Layer { look: Look::Rule, lines: vec![vec![[1e-3, 1.0], [1e3, 1.0]]], ..Layer::default() };
    let layers = std::iter::once(rule).chain((0..count).map(curve)).collect();
    diagram_svg(&Diagram {
        title: format!("Strength and error, maps of {size} texels; spots: what least-error chose"),
        x_name: "strength κλ, spaced as the logarithm of 1 + κλ".to_owned(),
        y_name: "wrong pixels, multiples of the focused map's".to_owned(),
        x_ticks: NAMED_STRENGTHS.map(|at| Tick { at: 1.0 + at, says: at.to_string() }).into(),
        layers,
    })
}

/// Measured over predicted error of every picture of the sweep, both as multiples of those without a warp.
pub(crate) fn predicted(cells: &Cells) -> String {
    let mut layers = vec![Layer {
        name: "as predicted".to_owned(),
        look: Look::Rule,
        lines: vec![vec![[1e-3, 1e-3], [1e3, 1e3]]],
        ..Layer::default()
    }];
    // The set with the most lines lies lowest.
    for style in [1, 0, 2] {
        let (set, called) = SETS[style];
        let lines: Vec<Vec<[f64; 2]>> = cells
            .of_set(set)
            .map(|cell| cell.swept.iter().map(|record| cell.predicted_and_measured(record)).collect())
            .collect();
        if !lines.is_empty() {
            layers.push(Layer { name: called.to_owned(), style, look: Look::Thin, lines, spots: Vec::new() });
        }
    }
    diagram_svg(&Diagram {
        title: "Predicted and measured error of every strength; one line per case and size".to_owned(),
        x_name: "predicted error, multiples of that without a warp".to_owned(),
        y_name: "wrong pixels, multiples of those without a warp".to_owned(),
        x_ticks: Vec::new(),
        layers,
    })
}

/// Depths of the picture of errors over depth.
const DEPTHS: [f64; 2] = [1.0, 100.0];
/// Points of one of its curves.
const STEPS: i32 = 200;

/// E(z) of four layouts, with their crossings.
pub(crate) fn errors_of_depth() -> String {
    let (uniform, logarithmic) = (Layout::Uniform, Layout::Logarithmic);
    let [none, ten] = [0.0, 10.0].map(|pull_back| Layout::Projection { pull_back });
    let depths = (0..=STEPS).map(|step| DEPTHS[0] * (DEPTHS[1] / DEPTHS[0]).powf(f64::from(step) / f64::from(STEPS)));
    let curves = [
        ("uniform", uniform),
        ("logarithmic", logarithmic),
        ("projection from the eye, o = 0", none),
        ("projection pulled back by o = 10", ten),
    ];
    let mut layers: Vec<Layer> = curves
        .into_iter()
        .enumerate()
        .map(|(style, (name, layout))| {
            let line = depths.clone().map(|z| [z, layout.error(DEPTHS, z)]).collect();
            Layer { name: name.to_owned(), style, lines: vec![line], ..Layer::default() }
        })
        .collect();
    // Each crossing with the side of its label where no curve passes.
    let crossings = [
        (uniform, none, [1.0, 100.0], [-1, 0]),
        (uniform, ten, [1.0, 100.0], [0, -1]),
        (logarithmic, uniform, [1.0, 100.0], [1, 1]),
        (logarithmic, ten, [1.0, 10.0], [1, 1]),
        (logarithmic, ten, [10.0, 100.0], [1, -1]),
    ];
    let spots = crossings.into_iter().filter_map(|(a, b, between, side)| {
        let z = crossing(a, b, DEPTHS, between)?;
        let label = format!("{z:.3}");
        Some(Spot { at: [z, a.error(DEPTHS, z)], told: format!("equal at z = {z:.6}"), label, side })
    });
    layers.push(Layer {
        name: "crossings, at depth z".to_owned(),
        style: 6,
        spots: spots.collect(),
        ..Layer::default()
    });
    diagram_svg(&Diagram {
        title: "Error of a map over depth, depths 1 to 100".to_owned(),
        x_name: "depth z".to_owned(),
        y_name: "E(z) = (dz/ds) / z".to_owned(),
        x_ticks: Vec::new(),
        layers,
    })
}
