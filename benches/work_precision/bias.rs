//! What a depth bias leaves, in one picture: a small part of what `cargo bench --bench bias_study` measures.

use std::fmt::Write as _;

use antumbra::Warp;
use antumbra::lab::bias_matrix::{ACNE, Cell, Goal, Map, Picture, SIDE, Way, picture};
use antumbra::lab::comparison::Assignment;

/// The viewpoint.
const CASE: &str = "figure";

/// Four biases in maps of linear depth.
pub(crate) fn measure() -> Result<Picture, String> {
    let city = Assignment::of_scene("sparse-city")?;
    let case = city.cases.iter().find(|case| case.name == CASE).ok_or(format!("no case {CASE}"))?;
    picture(&city.subject, case, &[Map::Linear], ("focused", Warp::Focused), &mut |_, _| Ok(()))
}

/// The section of the page.
pub(crate) fn section(text: &mut String, biases: &Picture) {
    let _ = writeln!(
        text,
        "### Of depths

{}, one focused map of {SIDE} texels, linear depth, hardware 2×2, drawn by the software renderer. *Acne* is false shadow away from edges,
*leak* light in shadow away from edges, % of {} pixels; *detachment* how far shadows begin from their casters, mean over {} contacts.
Strengths by hand are the least that leave at most {} % acne, and the least that leave no more than the automatic bias, searched by halving
(were acne to rise with strength somewhere, a still lesser one might do): tuned to this one picture, which no engine can do. [BIAS.md](BIAS.md) has warped maps, projective depth and maps of back faces as well.

| bias | strength | acne | leak | wrong | detachment, px | detached contacts |
|---|--:|--:|--:|--:|--:|--:|",
        biases.name,
        biases.valid,
        biases.contacts,
        100.0 * ACNE
    );
    for cell in &biases.cells {
        let goal = if cell.goal == Goal::AsAutomatic { ", as automatic" } else { "" };
        let _ = writeln!(
            text,
            "| {}{goal} | {} | {:.3} | {:.3} | {:.3} | {:.2} | {:.1} % |",
            cell.way.name(),
            strength(cell),
            100.0 * cell.acne,
            100.0 * cell.leak,
            100.0 * cell.wrong,
            cell.detached_px,
            100.0 * cell.detached
        );
    }
}

fn strength(cell: &Cell) -> String {
    let limit = if cell.enough { "" } else { "no less than " };
    match cell.way {
        Way::None | Way::Automatic => "–".to_owned(),
        Way::Constant => format!("{limit}{:.3}", cell.strength),
        Way::SlopeScaled => format!("{limit}{:.2} texels", cell.strength),
    }
}
