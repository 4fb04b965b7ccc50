//! Percentage-closer filters: the Rust twins of `shaders/pcf_*.wgsl` and `disc.wgsl`.
//!
//! # References
//! - Reeves, Salesin & Cook, *Rendering antialiased shadows with depth maps*, 1987 (compare, then average).
//! - Vogel, *A better way to construct the sunflower head*, 1979 (the spiral of a disc's taps).
//! - Fernando, *Percentage-closer soft shadows*, 2005.

use glam::{Vec2, Vec3, Vec4};

use super::depth::{CompareMap, Lookup, antumbra_law};
use super::spread::{ANTUMBRA_NARROWEST, Spread};
use crate::frame::Pcf;

/// Twin of `antumbra_tap`: one bilinear comparison at `offset` texels, against the receiver's own plane there.
#[must_use]
pub fn antumbra_tap(map: &impl CompareMap, look: &Lookup, offset: Vec2) -> f32 {
    let uv = look.uv + offset / map.size().as_vec2();
    map.sample_compare(uv, (look.depth + look.slope.dot(offset)).min(1.0))
}

/// Twin of `antumbra_filter`, for every filter.
#[must_use]
pub fn antumbra_filter(filter: Pcf, map: &impl CompareMap, look: &Lookup) -> f32 {
    let size = map.size().as_vec2();
    match filter {
        Pcf::Point => map.sample_compare(((look.uv * size).floor() + 0.5) / size, look.depth.min(1.0)),
        Pcf::Hardware2x2 => map.sample_compare(look.uv, look.depth.min(1.0)),
        Pcf::Box3x3 => box_three(map, look, fraction(look.uv, size)),
        Pcf::Box5x5 => box_five(map, look, fraction(look.uv, size)),
        Pcf::Box7x7 => box_seven(map, look, fraction(look.uv, size)),
        Pcf::Disc => disc(map, look),
        Pcf::Pcss => soft(map, look),
        Pcf::Pixel => super::pixel::pixel(map, look),
    }
}

fn box_three(map: &impl CompareMap, look: &Lookup, f: Vec2) -> f32 {
    let first = 1.0 / (2.0 - f) - 1.0 - f;
    let last = f / (1.0 + f) + 1.0 - f;
    let lower = antumbra_tap(map, look, first) * (2.0 - f.x)
        + antumbra_tap(map, look, Vec2::new(last.x, first.y)) * (1.0 + f.x);
    let upper =
        antumbra_tap(map, look, Vec2::new(first.x, last.y)) * (2.0 - f.x) + antumbra_tap(map, look, last) * (1.0 + f.x);
    (lower * (2.0 - f.y) + upper * (1.0 + f.y)) / 9.0
}

fn box_five(map: &impl CompareMap, look: &Lookup, f: Vec2) -> f32 {
    let first = 1.0 / (2.0 - f) - 2.0 - f;
    let middle = 0.5 - f;
    let last = f / (1.0 + f) + 2.0 - f;
    let x = Vec3::new(first.x, middle.x, last.x);
    let weight = Vec3::new(2.0 - f.x, 2.0, 1.0 + f.x);
    (antumbra_box_row(map, look, x, weight, first.y) * (2.0 - f.y)
        + antumbra_box_row(map, look, x, weight, middle.y) * 2.0
        + antumbra_box_row(map, look, x, weight, last.y) * (1.0 + f.y))
        / 25.0
}

fn box_seven(map: &impl CompareMap, look: &Lookup, f: Vec2) -> f32 {
    let first = 1.0 / (2.0 - f) - 3.0 - f;
    let last = f / (1.0 + f) + 3.0 - f;
    let x = Vec4::new(first.x, -0.5 - f.x, 1.5 - f.x, last.x);
    let weight = Vec4::new(2.0 - f.x, 2.0, 2.0, 1.0 + f.x);
    (antumbra_box_row_of_four(map, look, x, weight, first.y) * (2.0 - f.y)
        + antumbra_box_row_of_four(map, look, x, weight, -0.5 - f.y) * 2.0
        + antumbra_box_row_of_four(map, look, x, weight, 1.5 - f.y) * 2.0
        + antumbra_box_row_of_four(map, look, x, weight, last.y) * (1.0 + f.y))
        / 49.0
}

/// Twin of `antumbra_box_row`: three taps of a row.
#[must_use]
pub fn antumbra_box_row(map: &impl CompareMap, look: &Lookup, x: Vec3, weight: Vec3, y: f32) -> f32 {
    antumbra_tap(map, look, Vec2::new(x.x, y)) * weight.x
        + antumbra_tap(map, look, Vec2::new(x.y, y)) * weight.y
        + antumbra_tap(map, look, Vec2::new(x.z, y)) * weight.z
}

/// Twin of `antumbra_box_row_of_four`: four taps of a row.
#[must_use]
pub fn antumbra_box_row_of_four(map: &impl CompareMap, look: &Lookup, x: Vec4, weight: Vec4, y: f32) -> f32 {
    antumbra_tap(map, look, Vec2::new(x.x, y)) * weight.x
        + antumbra_tap(map, look, Vec2::new(x.y, y)) * weight.y
        + antumbra_tap(map, look, Vec2::new(x.z, y)) * weight.z
        + antumbra_tap(map, look, Vec2::new(x.w, y)) * weight.w
}

/// Place of a point between texel centres.
fn fraction(uv: Vec2, size: Vec2) -> Vec2 {
    let at = uv * size - 0.5;
    at - at.floor()
}

/// Twin of the shader's constant: a whole turn, radians.
const ANTUMBRA_TURN: f32 = core::f32::consts::TAU;

/// Twin of the shader's constant: cosine and sine of the golden angle, π(3 − √5).
const ANTUMBRA_GOLDEN: Vec2 = Vec2::new(-0.737_368_9, 0.675_490_3);

/// Twin of the shader's constant: radius of the disc of [`Pcf::Disc`], texels.
const ANTUMBRA_DISC_RADIUS: f32 = 3.0;

/// Twin of the shader's constant: texels that [`Pcf::Pcss`] searches for casters.
pub(crate) const ANTUMBRA_SEARCHED: u32 = 16;

/// Twin of the shader's constant: by how much w may change on the way to a texel.
const ANTUMBRA_LEAST_LEFT: f32 = 0.5;

/// Twin of `antumbra_turned`: the direction of the first point of a disc that is turned by a share of a whole turn.
#[must_use]
pub fn antumbra_turned(noise: f32) -> Vec2 {
    let angle = (noise - (noise + 0.5).floor()) * ANTUMBRA_TURN;
    Vec2::new(angle.cos(), angle.sin())
}

/// Twin of `antumbra_next`: the direction of the point after one.
#[must_use]
pub fn antumbra_next(direction: Vec2) -> Vec2 {
    Vec2::new(
        direction.x * ANTUMBRA_GOLDEN.x - direction.y * ANTUMBRA_GOLDEN.y,
        direction.x * ANTUMBRA_GOLDEN.y + direction.y * ANTUMBRA_GOLDEN.x,
    )
}

/// Twin of `antumbra_out`: how far out a point is, 0 to 1.
#[must_use]
pub fn antumbra_out(point: u32, points: u32) -> f32 {
    ((point as f32 + 0.5) / points as f32).sqrt()
}

/// The points of a disc of radius 1 whose first one lies in a direction.
fn points(first: Vec2, count: u32) -> impl Iterator<Item = Vec2> {
    let directions = core::iter::successors(Some(first), |direction| Some(antumbra_next(*direction)));
    directions.zip(0..count).map(move |(direction, point)| direction * antumbra_out(point, count))
}

fn disc(map: &impl CompareMap, look: &Lookup) -> f32 {
    let count = Pcf::Disc.samples();
    let points = points(antumbra_turned(look.spread.noise), count);
    points.map(|point| antumbra_tap(map, look, point * ANTUMBRA_DISC_RADIUS)).sum::<f32>() / count as f32
}

/// Twin of `antumbra_soft_offset`: texels from a receiver to a point of the disc whose radius is the penumbra of a
/// caster at a distance.
#[must_use]
pub fn antumbra_soft_offset(spread: &Spread, point: Vec2, apart: f32) -> Vec2 {
    (spread.along * point.x + spread.across * point.y) * apart
}

/// Twin of `antumbra_settled`: a lookup whose bias is that of a disc of this radius, texels, instead of the widest one.
#[must_use]
pub fn antumbra_settled(look: &Lookup, radius: f32) -> Lookup {
    let widest = (Pcf::Pcss.reach() - Pcf::Pcss.tap_reach()) as f32;
    let back = look.spread.back * (widest - radius).max(0.0);
    Lookup { uv: look.uv + back.truncate(), depth: look.depth + back.z, ..*look }
}

/// Twin of `antumbra_caster_distance`: how far casters are from the receiver on the average, in linear light depth; -1
/// where there are none.
#[must_use]
pub fn antumbra_caster_distance(map: &impl CompareMap, look: &Lookup, turned: Vec2) -> f32 {
    let (size, spread) = (map.size().as_vec2(), &look.spread);
    let farthest = spread.depth.max(3.0 * spread.least).min(spread.most.max(3.0 * spread.least));
    let (mut sum, mut casters) = (0.0, 0.0);
    for point in points(turned, ANTUMBRA_SEARCHED) {
        let texel = (look.uv * size + antumbra_soft_offset(spread, point, farthest)).floor();
        let stored = map.depth(texel);
        let plane = look.depth + look.slope.dot(texel + 0.5 - look.uv * size);
        if stored < plane.min(1.0) {
            let left = (1.0 - spread.fade.dot(point) * farthest).max(ANTUMBRA_LEAST_LEFT);
            sum += (spread.depth - stored / antumbra_law(spread.shape, spread.w / left)).max(0.0);
            casters += 1.0;
        }
    }
    if casters > 0.0 { sum / casters } else { -1.0 }
}

fn soft(map: &impl CompareMap, look: &Lookup) -> f32 {
    let (turned, spread, count) = (antumbra_turned(look.spread.noise), &look.spread, Pcf::Pcss.samples());
    let found = antumbra_caster_distance(map, &antumbra_settled(look, 0.0), turned);
    if found < 0.0 {
        return 1.0;
    }
    let apart = found.max(spread.least).min(spread.most);
    let settled = antumbra_settled(look, ANTUMBRA_NARROWEST * apart / spread.least);
    let tap = |point| antumbra_tap(map, &settled, antumbra_soft_offset(spread, point, apart));
    points(turned, count).map(tap).sum::<f32>() / count as f32
}

#[cfg(test)]
mod tests {
    use super::super::depth::DepthMap;
    use super::*;
    use glam::UVec2;
    use proptest::prelude::*;

    /// A map whose left half is near and right half far.
    fn half_map(depth: &mut Vec<f32>) -> DepthMap<'_> {
        depth.clear();
        depth.extend((0..16 * 16).map(|i| if i % 16 < 8 { 0.25 } else { 0.75 }));
        DepthMap { size: UVec2::splat(16), depth }
    }

    proptest! {
        /// Each filter is a mean: within [0, 1], 1 for receivers in front of everything, 0 behind everything, and
        /// across a straight edge it is the box's overlap with the lit half.
        #[test]
        fn filters_average(u in 0.3..0.7_f32, v in 0.3..0.7_f32, index in 0..Pcf::ALL.len()) {
            let filter = Pcf::ALL[index];
            let mut depth = Vec::new();
            let map = half_map(&mut depth);
            let spread = Spread { along: Vec2::X, across: Vec2::Y, least: 0.5, most: 0.5, ..Spread::default() };
            let at = |depth| antumbra_filter(filter, &map, &Lookup { uv: Vec2::new(u, v), depth, slope: Vec2::ZERO, spread });
            prop_assert!((at(0.1) - 1.0).abs() < 1e-5);
            prop_assert!(at(0.9).abs() < 1e-5);
            let width = match filter {
                Pcf::Point => 1e-6,
                Pcf::Hardware2x2 => 1.0,
                Pcf::Box3x3 => 3.0,
                Pcf::Box5x5 => 5.0,
                Pcf::Box7x7 => 7.0,
                // No boxes.
                Pcf::Disc | Pcf::Pcss | Pcf::Pixel => return Ok(()),
            };
            let expected = ((u * 16.0 - 8.0) / width + 0.5).clamp(0.0, 1.0);
            // Samplers keep 8 bits of the position between texels.
            if filter != Pcf::Point || (u * 16.0 - 8.0).abs() > 1e-3 {
                prop_assert!((at(0.5) - expected).abs() < 0.01, "{} {}", at(0.5), expected);
            }
        }
    }

    /// Discs as well, averaged over their turns: the share of a disc of that radius that lies over the lit half.
    #[test]
    fn discs_average() {
        let (turns, mut depth) = (256_u16, Vec::new());
        let map = half_map(&mut depth);
        let mean = |filter, u| {
            let spread = |noise| Spread {
                noise,
                // So far from its casters that the disc is as wide as may be.
                depth: 100.0,
                along: Vec2::X,
                across: Vec2::Y,
                w: 1.0,
                least: 0.5,
                most: 3.0,
                ..Spread::default()
            };
            let look = |noise| Lookup { uv: Vec2::new(u, 0.5), depth: 0.5, slope: Vec2::ZERO, spread: spread(noise) };
            let lit = (0..turns).map(|turn| antumbra_filter(filter, &map, &look(f32::from(turn) / f32::from(turns))));
            lit.sum::<f32>() / f32::from(turns)
        };
        for step in -20..=20_i8 {
            let across = f32::from(step) / 5.0;
            let u = 0.5 + across / 16.0;
            // Of the unit disc, left of a line at x; edges are a texel wide, which a disc of three hardly shows.
            let x = (across / 3.0).clamp(-1.0, 1.0);
            let expected = 0.5 + (x * (1.0 - x * x).sqrt() + x.asin()) / core::f32::consts::PI;
            let found = mean(Pcf::Disc, u);
            assert!((found - expected).abs() < 0.03, "{across}: {found}, {expected}");
            let found = mean(Pcf::Pcss, u);
            assert!((found - expected).abs() < 0.03, "{across}: {found}, {expected}");
        }
    }
}
