//! How far a shadow mask is from the truth: one definition for every table and plot.
//!
//! A mask holds one value per pixel, 0 (shadow) to 1 (light), row 0 on top. Only the truth's valid pixels count. With
//! v the mask, a the area truth, c the centre truth:
//!
//! | figure | definition |
//! |---|---|
//! | `rmse`, `mae` | root mean square and mean of \|v − a\| |
//! | `floor_rmse`, `floor_mae` | the same for v = c: what a perfect hard-edged mask scores |
//! | `excess` | `mae` − `floor_mae`; negative when a filter beats the hard edge |
//! | `wrong`, `wrong_center` | fraction with \|v − a\| > ½, \|v − c\| > ½ |
//! | `leak_…`, `false_…` | `wrong_center` apart: light where none is (v > c), shadow where none is (v < c) |
//! | `…_edge`, `…_interior` | the same apart: up to 2 px (Chebyshev) from an edge pixel, or further |
//! | `…_interior_strict` | as `…_interior`, from strict edges alone |
//! | `edge_center_px` | mean distance from the centre truth's shadow edges to the mask's, pixels |
//!
//! An *edge pixel* is a valid pixel that a shadow's edge passes through or beside: its area truth is strictly between 0
//! and 1, or a valid 4-neighbour has another centre truth. The first half matters for shadows thinner than a pixel,
//! which the grid of centres may not see. A *strict* edge pixel is one of the second half only: then a shadow between
//! the centres has no edge, and a map that shows it is counted as acne.
//!
//! `edge_center_px` looks at pairs of 4-neighbours on one surface ([`Truth::joins`]) whose centre truths differ: the
//! truth's edge lies half-way between them. The mask's edges lie between such pairs on opposite sides of ½, where the
//! line through their values crosses ½. Each truth edge takes the Euclidean distance to the nearest mask edge that
//! darkens along the same direction, at most [`EDGE_SEARCH_PX`]; silhouettes, where nothing can be matched, stay out.

pub mod detachment;

use super::truth::{JOINS_BELOW, JOINS_RIGHT, Truth};

/// How near to an edge pixel, in pixels along both axes, a wrong pixel counts as an edge's: an edge displaced by up to
/// two pixels is resolution, further out it is bleeding or acne.
pub const EDGE_REACH_PX: u32 = 2;

/// How far from a truth edge a mask edge is looked for, pixels; what is further off counts as this. Less would hide
/// gross displacement, more would match edges of other shadows.
pub const EDGE_SEARCH_PX: u32 = 8;

/// What makes an edge pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// The area truth is strictly between 0 and 1, or a valid 4-neighbour has another centre truth.
    Area,
    /// A valid 4-neighbour has another centre truth (strict).
    Centre,
}

/// Why a mask cannot be scored.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MaskError {
    /// The mask has another number of pixels than the truth.
    Size {
        /// Pixels of the truth.
        expected: usize,
        /// Pixels of the mask.
        got: usize,
    },
    /// A value is not between 0 and 1.
    Value {
        /// Pixel, row by row from the top.
        index: usize,
        /// Its value.
        value: f32,
    },
}

impl std::fmt::Display for MaskError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Size { expected, got } => write!(f, "mask has {got} pixels; legal is {expected}, as the truth has"),
            Self::Value { index, value } => write!(f, "mask is {value} at pixel {index}; legal is 0 to 1"),
        }
    }
}

impl std::error::Error for MaskError {}

/// The figures of one mask; fractions of valid pixels unless said otherwise. All zero when no pixel is valid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scores {
    /// Number of valid pixels.
    pub valid_pixels: usize,
    /// Root mean square error against the area truth, 0 to 1.
    pub rmse: f64,
    /// Mean absolute error against the area truth, 0 to 1.
    pub mae: f64,
    /// `rmse` of the perfect hard-edged mask.
    pub floor_rmse: f64,
    /// `mae` of the perfect hard-edged mask.
    pub floor_mae: f64,
    /// `mae` − `floor_mae`, −1 to 1.
    pub excess: f64,
    /// Fraction more than ½ off the area truth.
    pub wrong: f64,
    /// Fraction more than ½ off the centre truth: the four below together.
    pub wrong_center: f64,
    /// Mean distance from the truth's shadow edges to the mask's, pixels; `None` without edges on a surface.
    pub edge_center_px: Option<f64>,
    /// Light where there is none, near an edge.
    pub leak_edge: f64,
    /// Light where there is none, away from edges: bleeding.
    pub leak_interior: f64,
    /// Shadow where there is none, near an edge.
    pub false_edge: f64,
    /// Shadow where there is none, away from edges: acne.
    pub false_interior: f64,
    /// Light where there is none, away from strict edges ([`Edges::Centre`]); at least `leak_interior`.
    pub leak_interior_strict: f64,
    /// Shadow where there is none, away from strict edges ([`Edges::Centre`]); at least `false_interior`.
    pub false_interior_strict: f64,
    /// The valid pixels in three parts of equal count by eye depth, nearest first.
    pub thirds: [Third; 3],
}

/// The figures of a third of the valid pixels; fractions are of that third.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Third {
    /// Least eye depth, world units.
    pub depth_min: f32,
    /// Greatest eye depth, world units.
    pub depth_max: f32,
    /// Root mean square error against the area truth.
    pub rmse: f64,
    /// Mean absolute error against the area truth.
    pub mae: f64,
    /// Fraction more than ½ off the centre truth.
    pub wrong_center: f64,
}

/// Widens an 8-bit mask (255 lit) to 0..=1.
#[must_use]
pub fn mask_from_bytes(bytes: &[u8]) -> Vec<f32> {
    bytes.iter().map(|&byte| f32::from(byte) / f32::from(u8::MAX)).collect()
}

impl Scores {
    /// Scores a mask.
    ///
    /// # Errors
    /// [`MaskError`] when the mask has the wrong size or a value that is not in 0..=1.
    pub fn new(mask: &[f32], truth: &Truth) -> Result<Self, MaskError> {
        check(mask, truth)?;
        let valid: Vec<usize> = (0..mask.len()).filter(|&pixel| truth.valid[pixel]).collect();
        // Compare with the area truth, and the perfect hard edge likewise.
        let (rmse, mae) = errors(mask, &truth.area, &valid);
        let (floor_rmse, floor_mae) = errors(&truth.centre, &truth.area, &valid);
        // Compare with the centre truth, by sign and place.
        let (near_edge, near_strict) = (near_edges(truth, Edges::Area), near_edges(truth, Edges::Centre));
        let wrong_where = |leak: bool, near: &[bool], edge: bool| {
            let wrong = |pixel: usize| {
                let error = mask[pixel] - truth.centre[pixel];
                error.abs() > HALF && (error > 0.0) == leak && near[pixel] == edge
            };
            fraction(&valid, wrong)
        };
        Ok(Self {
            valid_pixels: valid.len(),
            rmse,
            mae,
            floor_rmse,
            floor_mae,
            excess: mae - floor_mae,
            wrong: fraction(&valid, |pixel| (mask[pixel] - truth.area[pixel]).abs() > HALF),
            wrong_center: fraction(&valid, |pixel| (mask[pixel] - truth.centre[pixel]).abs() > HALF),
            edge_center_px: edge_displacement(mask, truth),
            leak_edge: wrong_where(true, &near_edge, true),
            leak_interior: wrong_where(true, &near_edge, false),
            false_edge: wrong_where(false, &near_edge, true),
            false_interior: wrong_where(false, &near_edge, false),
            leak_interior_strict: wrong_where(true, &near_strict, false),
            false_interior_strict: wrong_where(false, &near_strict, false),
            thirds: thirds(mask, truth, valid),
        })
    }
}

/// Between light and shadow.
const HALF: f32 = 0.5;

/// Mean of |Δv − Δa| from one picture to the next over the pixels valid in both: change that the truth does not have.
///
/// # Errors
/// [`MaskError`] when a mask does not fit its truth, or the two pictures differ in size.
pub fn flicker(previous: (&[f32], &Truth), next: (&[f32], &Truth)) -> Result<f64, MaskError> {
    check(previous.0, previous.1)?;
    check(next.0, next.1)?;
    check(next.0, previous.1)?;
    let both: Vec<usize> = (0..next.0.len()).filter(|&i| previous.1.valid[i] && next.1.valid[i]).collect();
    let change = |pixel: usize| {
        let mask = f64::from(next.0[pixel]) - f64::from(previous.0[pixel]);
        let truth = f64::from(next.1.area[pixel]) - f64::from(previous.1.area[pixel]);
        (mask - truth).abs()
    };
    Ok(mean(&both, change))
}

/// Paints v − a: red where light leaks, blue where shadow is false, over a dim picture of the area truth; what is not
/// valid is dark grey. Three bytes per pixel, row 0 on top.
///
/// # Errors
/// [`MaskError`] when the mask does not fit the truth.
pub fn heat_map(mask: &[f32], truth: &Truth) -> Result<Vec<u8>, MaskError> {
    check(mask, truth)?;
    let paint = |pixel: usize| {
        if !truth.valid[pixel] {
            return INVALID_COLOUR;
        }
        // Blend from the dim truth to the full colour as the error grows; the square root shows small errors.
        let error = mask[pixel] - truth.area[pixel];
        let colour = if error > 0.0 { LEAK_COLOUR } else { FALSE_COLOUR };
        let ground = DIM_SHADOW + (DIM_LIGHT - DIM_SHADOW) * truth.area[pixel];
        let strength = error.abs().sqrt();
        colour.map(|channel| (ground + (channel - ground) * strength).round() as u8)
    };
    Ok((0..mask.len()).flat_map(paint).collect())
}

/// Colours of the heat map, 8-bit sRGB: leaks, false shadow, what is not valid, and the greys of shadow and light.
const LEAK_COLOUR: [f32; 3] = [255.0, 96.0, 32.0];
const FALSE_COLOUR: [f32; 3] = [48.0, 128.0, 255.0];
const INVALID_COLOUR: [u8; 3] = [24, 24, 28];
const DIM_SHADOW: f32 = 48.0;
const DIM_LIGHT: f32 = 128.0;

fn check(mask: &[f32], truth: &Truth) -> Result<(), MaskError> {
    let expected = truth.valid.len();
    if mask.len() != expected {
        return Err(MaskError::Size { expected, got: mask.len() });
    }
    match mask.iter().position(|value| !(0.0..=1.0).contains(value)) {
        Some(index) => Err(MaskError::Value { index, value: mask[index] }),
        None => Ok(()),
    }
}

/// Mean over pixels; 0 without any.
fn mean(pixels: &[usize], value: impl Fn(usize) -> f64) -> f64 {
    let sum: f64 = pixels.iter().map(|&pixel| value(pixel)).sum();
    sum / pixels.len().max(1) as f64
}

fn fraction(pixels: &[usize], holds: impl Fn(usize) -> bool) -> f64 {
    mean(pixels, |pixel| f64::from(u8::from(holds(pixel))))
}

/// Root mean square and mean absolute difference.
fn errors(mask: &[f32], truth: &[f32], pixels: &[usize]) -> (f64, f64) {
    let error = |pixel: usize| (f64::from(mask[pixel]) - f64::from(truth[pixel])).abs();
    (mean(pixels, |pixel| error(pixel).powi(2)).sqrt(), mean(pixels, error))
}

fn thirds(mask: &[f32], truth: &Truth, mut valid: Vec<usize>) -> [Third; 3] {
    // A stable order by depth: equal depths stay in picture order.
    valid.sort_by(|&a, &b| truth.depth[a].total_cmp(&truth.depth[b]));
    let count = valid.len();
    std::array::from_fn(|third| {
        let pixels = &valid[count * third / 3..count * (third + 1) / 3];
        let (rmse, mae) = errors(mask, &truth.area, pixels);
        let depth = |pixel: Option<&usize>| pixel.map_or(0.0, |&pixel| truth.depth[pixel]);
        Third {
            depth_min: depth(pixels.first()),
            depth_max: depth(pixels.last()),
            rmse,
            mae,
            wrong_center: fraction(pixels, |pixel| (mask[pixel] - truth.centre[pixel]).abs() > HALF),
        }
    })
}

/// Marks the pixels up to [`EDGE_REACH_PX`] from an edge pixel, valid or not.
#[must_use]
pub fn near_edges(truth: &Truth, edges: Edges) -> Vec<bool> {
    let (width, height) = (truth.width as usize, truth.height as usize);
    let cut = |i: usize| edges == Edges::Area && truth.valid[i] && truth.area[i] > 0.0 && truth.area[i] < 1.0;
    let mut edge: Vec<bool> = (0..width * height).map(cut).collect();
    let mut compare = |a: usize, b: usize| {
        if truth.valid[a] && truth.valid[b] && truth.centre[a] != truth.centre[b] {
            (edge[a], edge[b]) = (true, true);
        }
    };
    for index in 0..width * height {
        if !(index + 1).is_multiple_of(width) {
            compare(index, index + 1);
        }
        if index + width < width * height {
            compare(index, index + width);
        }
    }
    // Grow along rows, then along columns: a square.
    let reach = EDGE_REACH_PX as usize;
    let rows = |i: usize| (i - (i % width).min(reach)..=i + (width - 1 - i % width).min(reach)).any(|j| edge[j]);
    let grown: Vec<bool> = (0..edge.len()).map(rows).collect();
    let columns = |i: usize| {
        let (x, y) = (i % width, i / width);
        (y.saturating_sub(reach)..=(y + reach).min(height - 1)).any(|row| grown[row * width + x])
    };
    (0..edge.len()).map(columns).collect()
}

/// An edge between two neighbouring pixel centres.
#[derive(Clone, Copy)]
struct Crossing {
    /// Place in pixels; pixel centres lie at whole numbers.
    x: f64,
    y: f64,
    /// 0 to the right or 1 downwards, whichever way the neighbours lie, and whether light falls on that way.
    kind: (u8, bool),
}

/// Lists where a picture crosses ½ between neighbours on one surface.
fn crossings(values: &[f32], truth: &Truth) -> Vec<Crossing> {
    let width = truth.width as usize;
    let mut found = Vec::new();
    for index in 0..values.len() {
        for (axis, bit, neighbour) in [(0, JOINS_RIGHT, index + 1), (1, JOINS_BELOW, index + width)] {
            if truth.joins[index] & bit == 0 {
                continue;
            }
            let (a, b) = (values[index], values[neighbour]);
            if (a < HALF) != (b < HALF) {
                let along = f64::from((HALF - a) / (b - a));
                let (x, y) = ((index % width) as f64, (index / width) as f64);
                let (x, y) = if axis == 0 { (x + along, y) } else { (x, y + along) };
                found.push(Crossing { x, y, kind: (axis, a > b) });
            }
        }
    }
    found
}

/// Mean distance from the truth's edges to the mask's; `None` without edges.
fn edge_displacement(mask: &[f32], truth: &Truth) -> Option<f64> {
    let (width, height) = (truth.width as usize, truth.height as usize);
    let truth_edges = crossings(&truth.centre, truth);
    // Sort the mask's edges into the pixels they lie in.
    let mut buckets: Vec<Vec<Crossing>> = vec![Vec::new(); width * height];
    for crossing in crossings(mask, truth) {
        buckets[crossing.y as usize * width + crossing.x as usize].push(crossing);
    }
    // Take the nearest one of the same kind for each edge of the truth.
    let reach = EDGE_SEARCH_PX as usize;
    let distance = |edge: &Crossing| {
        let (column, row) = (edge.x as usize, edge.y as usize);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(height);
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(width);
        let near = rows.flat_map(|y| &buckets[y * width + columns.start..y * width + columns.end]).flatten();
        let same_kind = near.filter(|found| found.kind == edge.kind);
        same_kind.fold(f64::from(EDGE_SEARCH_PX), |least, found| least.min((found.x - edge.x).hypot(found.y - edge.y)))
    };
    let sum: f64 = truth_edges.iter().map(distance).sum();
    (!truth_edges.is_empty()).then(|| sum / truth_edges.len() as f64)
}

#[cfg(test)]
mod tests;
