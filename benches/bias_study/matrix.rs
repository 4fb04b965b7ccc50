//! The matrices of three pictures.

use antumbra::Warp;
use antumbra::lab::bias_matrix::{Cell, Map, Picture, picture};
use antumbra::lab::comparison::Assignment;
use antumbra::lab::truth::Truth;

/// Draws all of them.
pub(crate) fn pictures() -> Result<Vec<Picture>, String> {
    let city = Assignment::of_scene("sparse-city")?;
    let drawn = |name: &str, called: &'static str, warp: Warp| {
        let case = city.cases.iter().find(|case| case.name == name).ok_or(format!("no case {name}"))?;
        let mut keep = |cell: &Cell, truth: &Truth| {
            let Cell { map, way, goal, strength, acne, leak, detached_px, .. } = cell;
            println!(
                "{name}, {called}, {map:?}, {way:?} {goal:?} {strength}: acne {acne}, leak {leak}, {detached_px} px"
            );
            let file = format!("{name} {called} {} {} {goal:?}", map.name(), way.name());
            crate::save(&file, &cell.mask, truth)
        };
        picture(&city.subject, case, &Map::ALL, (called, warp), &mut keep)
    };
    Ok(vec![
        drawn("figure", "focused, no warp", Warp::Focused)?,
        drawn("across", "light-space perspective, unguarded", Warp::LightSpacePerspective)?,
        drawn("across", "perspective shadow map, unguarded", Warp::Perspective { pull_back: 0.0 })?,
    ])
}
