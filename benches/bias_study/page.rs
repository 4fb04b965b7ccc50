//! The page of the study, and its plots.

use std::fmt::Write as _;

use antumbra::lab::bias_matrix::{ACNE, Cell, Goal, Map, Picture, SIDE, Way};
use antumbra::lab::metrics::detachment::STRIP_PX;
use antumbra::lab::report::{Diagram, Layer, Look, Spot, diagram_svg};

use crate::gz::{self, INT_MAX, REPORT, SECOND_CAMERA, Step, Swept};

const HEAD: &str = "# Bias: self-shadowing and detachment, measured

This page is written by the command below; every number of a measurement on it comes from that run.
";

/// What is measured, and how.
fn measures(text: &mut String) {
    let _ = writeln!(
        text,
        "
- *Acne*: pixels in false shadow more than two pixels away from every edge of the ray-traced truth, % of the pixels that the light can
  reach (`false_interior`). *Leak*: the same for light in true shadow (`leak_interior`). *Wrong*: more than half off the centre truth.
- *Detachment*: where the unlit side of a caster meets its receiver in the picture, how many pixels in true shadow are lit before the
  shadow begins, away from the caster along an axis of the picture, 0 to {STRIP_PX}; mean over all such contacts. *Detached*: contacts with at
  least one such pixel, %. `antumbra::lab::metrics::detachment` has the definition."
    );
}

pub(crate) fn page(meta: &[(&str, String)], sweep: &[Swept], pictures: &[Picture]) -> String {
    let mut text = HEAD.to_owned();
    text.push('\n');
    for (name, value) in meta {
        let _ = writeln!(text, "- {name}: `{value}`");
    }
    measures(&mut text);
    matrix(&mut text, pictures);
    report(&mut text, sweep);
    text
}

fn percent(share: f64) -> String {
    format!("{:.3}", 100.0 * share)
}

/// The matrix of both pictures.
fn matrix(text: &mut String, pictures: &[Picture]) {
    let _ = writeln!(
        text,
        "
## None, constant, slope-scaled, automatic

After Fig. 6 of D. Scherzer, *Robust shadow maps for large environments*: one map of {SIDE} texels, hardware 2×2 filter. *Constant* and
*slope-scaled* are `Bias::Manual` with `depth_world` (world units) or `slope_texels` alone, set by hand for each map and each picture: the
least strength, in steps of √2, that leaves at most {} % acne, and the least that leaves no more than the automatic bias does (*as
automatic*). They are searched by halving the range, which finds the least where acne falls with every step; where it does not, one step
less leaves too much, but fewer still might do. No engine can do that, its bias has to serve every picture; these are the best that such a bias can be. *Automatic* is the
default and has no strength. The bias is the receiver's, and taken off before the division by w: a constant that a rasteriser adds to
its hyperbolic depths afterwards grows with w, and was not measured. *Back faces only*: casters with front faces culled, in wgpu
`cull_mode: Some(Face::Front)` and the default counter-clockwise front faces; linear depth. It needs closed solids. The city's buildings
are; its ground is not, and casts nothing; pavements are thin slabs, whose lower sides shade their upper ones where depth changes
by more than their thickness from texel to texel.",
        100.0 * ACNE
    );
    for picture in pictures {
        let Picture { name, warp, contacts, valid, .. } = picture;
        let _ = writeln!(
            text,
            "\n| {name}: {warp} | bias | strength | acne | leak | wrong | detachment, px | detached |\n|---|---|--:|--:|--:|--:|--:|--:|"
        );
        for cell in &picture.cells {
            let Cell { map, acne, leak, wrong, detached_px, detached, .. } = cell;
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} | {} | {detached_px:.2} | {:.1} |",
                map.name(),
                called(cell),
                strength(cell),
                percent(*acne),
                percent(*leak),
                percent(*wrong),
                100.0 * detached
            );
        }
        let _ = writeln!(text, "\n{valid} pixels count, with {contacts} contacts. {}", verdict(picture));
    }
    text.push_str(&between(pictures));
}

fn called(cell: &Cell) -> String {
    let goal = if cell.goal == Goal::AsAutomatic { ", as automatic" } else { "" };
    format!("{}{goal}", cell.way.name())
}

fn strength(cell: &Cell) -> String {
    let limit = if cell.enough { "" } else { "no less than " };
    match cell.way {
        Way::None | Way::Automatic => "–".to_owned(),
        Way::Constant => format!("{limit}{:.3}", cell.strength),
        Way::SlopeScaled => format!("{limit}{:.2} texels", cell.strength),
    }
}

/// What a picture's table says.
fn verdict(picture: &Picture) -> String {
    let mut text = if picture.same(Map::Projective, Map::Linear) {
        "Without a warp both depths are one: the pictures are equal, byte by byte.".to_owned()
    } else {
        "Both depths differ here.".to_owned()
    };
    for map in distinct(picture) {
        let of = |way, goal| picture.cell(map, way, goal);
        let (Some(none), Some(automatic)) = (of(Way::None, Goal::Unseen), of(Way::Automatic, Goal::Unseen)) else {
            continue;
        };
        let rivals = [Way::Constant, Way::SlopeScaled].into_iter().filter_map(|way| of(way, Goal::AsAutomatic));
        let mut ranked: Vec<&Cell> = rivals.chain([automatic]).collect();
        ranked.sort_by(|a, b| a.detached_px.total_cmp(&b.detached_px));
        let ranked = ranked.iter().map(|cell| {
            if cell.enough || cell.way == Way::Automatic {
                format!("{} {:.2} px", cell.way.name(), cell.detached_px)
            } else {
                format!("{} at no strength", cell.way.name())
            }
        });
        let _ = write!(
            text,
            "\n- With *{}* the automatic bias takes acne from {} to {} %; at no more acne than that, from the least detachment: {}.",
            map.name(),
            percent(none.acne),
            percent(automatic.acne),
            ranked.collect::<Vec<_>>().join(", ")
        );
    }
    text + &rank(picture)
}

/// Kinds of map that differ.
fn distinct(picture: &Picture) -> impl Iterator<Item = Map> {
    let same = picture.same(Map::Projective, Map::Linear);
    Map::ALL.into_iter().filter(move |map| !(same && *map == Map::Projective))
}

/// Where the default stands among everything that leaves little enough acne.
fn rank(picture: &Picture) -> String {
    let counts = |cell: &&Cell| cell.goal == Goal::Unseen && cell.acne <= ACNE;
    let of = |map: Map| picture.cells.iter().filter(counts).filter(move |cell| cell.map == map);
    let mut clean: Vec<&Cell> = distinct(picture).flat_map(of).collect();
    clean.sort_by(|a, b| a.detached_px.total_cmp(&b.detached_px));
    let default = clean.iter().position(|cell| cell.map == Map::Linear && cell.way == Way::Automatic);
    let (Some(first), Some(default)) = (clean.first(), default) else { return String::new() };
    format!(
        "\n- Of the {} cells of this table with at most {} % acne (rows *as automatic* apart), the least detached is *{}, {}* with {:.2} px; the default, *linear \
         depth, automatic*, comes {} with {:.2} px.",
        clean.len(),
        100.0 * ACNE,
        first.map.name(),
        first.way.name(),
        first.detached_px,
        ordinal(default + 1),
        clean[default].detached_px
    )
}

fn ordinal(place: usize) -> String {
    match place {
        1 => "first".to_owned(),
        2 => "second".to_owned(),
        3 => "third".to_owned(),
        place => format!("{place}th"),
    }
}

/// How strengths carry over from one picture to the other.
fn between(pictures: &[Picture]) -> String {
    let [first, second, ..] = pictures else { return String::new() };
    let mut text =
        "\nHow strengths by hand carry over: for at most the same acne the second picture wants, of the first one's,"
            .to_owned();
    for map in Map::ALL {
        for way in [Way::Constant, Way::SlopeScaled] {
            if let (Some(a), Some(b)) = (first.cell(map, way, Goal::Unseen), second.cell(map, way, Goal::Unseen)) {
                let _ =
                    write!(text, " {} times the {} with {},", number(b.strength / a.strength), way.name(), map.name());
            }
        }
    }
    let _ = text.pop();
    text.push_str(".\n");
    text
}

fn number(ratio: f32) -> String {
    if ratio >= 10.0 { format!("{ratio:.0}") } else { format!("{ratio:.2}") }
}

/// The report's sweep.
fn report(text: &mut String, sweep: &[Swept]) {
    let _ = writeln!(
        text,
        "
## One constant for a teapot

After S. Bu, J. Bustos, S. L. Tan, *Implementation and assessment of software-based shadow mapping techniques*: the Utah teapot (Newell's control
points), two perspective lights, depths as whole numbers of 0 to INT_MAX, the texel that a pixel falls into, shadow where
`z_pixel − z_map > bias`, and a bias from ½ on by factors of √10. The report settled on 5·10⁵ = {:.3e} of the range, and on 8·10⁵ = {:.3e} for
another camera. It has neither the places of its lights nor its table, nor what its picture is made of; those are ours, with maps of {} texels a
side, so that its constants are compared in kind, not digit by digit.

![acne by bias](bias-acne.svg)

![detachment by bias](bias-detachment.svg)
",
        REPORT / INT_MAX,
        SECOND_CAMERA / INT_MAX,
        gz::SIDE
    );
    let names: Vec<String> =
        sweep.iter().map(|light| format!("{0}: acne | leak | detachment, px | detached", light.name)).collect();
    let _ = writeln!(text, "| bias | of INT_MAX | {} |", names.join(" | "));
    let _ = writeln!(text, "|--:|--:|{}", "--:|--:|--:|--:|".repeat(sweep.len()));
    let steps = sweep.first().map_or(0, |light| light.steps.len());
    for index in 0..steps {
        let bias = sweep[0].steps[index].bias;
        let cells: Vec<String> = sweep.iter().map(|light| cells(&light.steps[index])).collect();
        let _ = writeln!(text, "| {} | {:.2e} | {} |", whole(bias), bias / INT_MAX, cells.join(" | "));
    }
    text.push('\n');
    for light in sweep {
        let _ = writeln!(text, "- {}", found(light));
    }
    errata(text, sweep);
}

fn whole(bias: f64) -> String {
    if bias < 10.0 { format!("{bias:.2}") } else { format!("{bias:.0}") }
}

fn cells(step: &Step) -> String {
    format!("{} | {} | {:.2} | {:.1}", percent(step.acne), percent(step.leak), step.detached_px, 100.0 * step.detached)
}

/// What a light's sweep says.
fn found(light: &Swept) -> String {
    let enough = light.steps.iter().find(|step| step.acne <= ACNE);
    let at = light.steps.iter().min_by(|a, b| (a.bias - REPORT).abs().total_cmp(&(b.bias - REPORT).abs()));
    let mut text = format!("*{}* ({} pixels, {} contacts): ", light.name, light.valid, light.contacts);
    if let Some(step) = enough {
        let _ = write!(
            text,
            "the first bias that leaves at most {} % acne is {} = {:.2e} of the range, with {:.1} % of the contacts detached by {:.2} px in the mean. ",
            100.0 * ACNE,
            whole(step.bias),
            step.bias / INT_MAX,
            100.0 * step.detached,
            step.detached_px
        );
    }
    if let Some(step) = at {
        let _ = write!(
            text,
            "At the report's 5·10⁵ {} % acne are left and {:.1} % of the contacts are detached.",
            percent(step.acne),
            100.0 * step.detached
        );
    }
    text
}

/// The report's two claims that do not hold.
fn errata(text: &mut String, sweep: &[Swept]) {
    let most = |figure: fn(&Swept) -> f64| sweep.iter().map(figure).fold(0.0, f64::max);
    let means = sweep.iter().map(|light| {
        let [bare, filtered, biased] = light.light.map(|mean| 100.0 * mean);
        format!(
            "under {} {bare:.1} % without a bias, {filtered:.1} % after the filter, {biased:.1} % with 5·10⁵",
            light.name
        )
    });
    let _ = writeln!(
        text,
        "
The report calls its bias a low-pass filter. It is a threshold. A filter spreads acne and keeps its mean: a box of 5 × 5 pixels over the
mask without a bias leaves surfaces in full light as dark as they were, now evenly. The mean light on them, away from edges, is
{}. A threshold puts the light back, keeps edges as hard as they were, and takes shadow away where surfaces are near to each other.

It also found that light-space coordinates cannot be interpolated, and projected every pixel back. They can: interpolated as homogeneous
coordinates over w and divided in each pixel, depths are at most {:.1e} of INT_MAX units from projected ones; divided at the
vertices, as the report did it, up to {:.1e} units: compare with the biases of the table.",
        means.collect::<Vec<_>>().join("; "),
        most(|light| light.interpolated.homogeneous),
        most(|light| light.interpolated.divided)
    );
}

/// Name and text of each plot.
pub(crate) fn plots(sweep: &[Swept]) -> Vec<(&'static str, String)> {
    let draw = |title: &str, y_name: &str, figure: fn(&Step) -> f64| {
        let layer = |(style, light): (usize, &Swept)| {
            let line: Vec<[f64; 2]> = light.steps.iter().map(|step| [step.bias, figure(step)]).collect();
            let spots = light.steps.iter().map(|step| Spot {
                at: [step.bias, figure(step)],
                told: format!("{}: {:.3}", whole(step.bias), figure(step)),
                ..Spot::default()
            });
            let spots = spots.collect();
            Layer { name: light.name.to_owned(), style, look: Look::Curve, lines: vec![line], spots }
        };
        let rule = |at: f64| vec![[at, 1e-9], [at, 1e9]];
        let rules = Layer {
            name: "the report's 5·10⁵ and 8·10⁵".to_owned(),
            look: Look::Rule,
            lines: vec![rule(REPORT), rule(SECOND_CAMERA)],
            ..Layer::default()
        };
        diagram_svg(&Diagram {
            title: title.to_owned(),
            x_name: "bias, units of depth; the range is INT_MAX of them".to_owned(),
            y_name: y_name.to_owned(),
            x_ticks: Vec::new(),
            layers: std::iter::once(rules).chain(sweep.iter().enumerate().map(layer)).collect(),
        })
    };
    vec![
        ("bias-acne.svg", draw("Teapot: acne under one constant bias", "acne, %", |step| 100.0 * step.acne)),
        (
            "bias-detachment.svg",
            draw("Teapot: detachment under one constant bias", "detachment, px", |step| step.detached_px),
        ),
    ]
}
