//! The software z-buffer: draws triangles into a depth image by the rules GPUs follow, so that every experiment also
//! runs where there is no GPU.
//!
//! This is the renderer of the "Gz" project (software shadow mapping by z-buffer): one pass seen from the light keeps
//! depths only, one pass seen from the camera keeps depths and which triangle is visible. That report found that
//! light-space coordinates interpolated over a triangle "did not yield any shadow" and projected every pixel back
//! instead. Erratum: they *can* be interpolated, provided they are interpolated as homogeneous coordinates and divided
//! in each pixel. [`resolve`] projects back all the same, because a position found by intersecting the pixel's ray with
//! the triangle in `f64` does not inherit the rasteriser's rounding.
//!
//! Rules, as in Direct3D, Vulkan and Metal: vertices are narrowed to `f32` relative to an origin and transformed in
//! `f32`; triangles are clipped in homogeneous coordinates; screen positions snap to 1/256 pixel; a pixel belongs to a
//! triangle when its centre lies inside, or on a top or left edge; depth is linear on the screen. Both sides of a
//! triangle are drawn. Equal inputs give equal bits whatever the number of threads.
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "pixel and triangle numbers stay below 2^32; narrowing to f32 is what GPUs do"
)]

mod resolve;
mod setup;

use std::ops::Range;

use glam::{DVec3, Mat4, Vec4};
use rayon::prelude::*;

pub use resolve::{Hit, resolve};

use self::setup::{ScreenTriangle, Setup, Varyings};
use super::scene::{Cutout, SceneModel};

/// Marks a pixel without triangle in [`DepthTarget::triangle`].
pub const NONE: u32 = u32::MAX;

/// Rows one thread owns at a time. Taller bands balance worse over the cores; one-row bands look through the list of
/// triangles once per row.
const BAND_ROWS: usize = 32;

/// Triangles set up as one task. Small: the tasks cost more than the triangles. Large: fewer tasks than cores.
const SETUP_CHUNK: usize = 1024;

/// Which of two depths in one pixel survives; the later one of two equal depths does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthMode {
    /// 0 is nearest: cleared to 1, the lesser or equal depth survives (shadow maps).
    LessEqual,
    /// 1 is nearest (reversed z): cleared to 0, the greater or equal depth survives.
    GreaterEqual,
}

impl DepthMode {
    /// Depth of a pixel that nothing covers.
    #[must_use]
    pub fn cleared(self) -> f32 {
        match self {
            DepthMode::LessEqual => 1.0,
            DepthMode::GreaterEqual => 0.0,
        }
    }

    fn passes(self, new: f32, stored: f32) -> bool {
        match self {
            DepthMode::LessEqual => new <= stored,
            DepthMode::GreaterEqual => new >= stored,
        }
    }
}

/// A depth image and, beside it, which triangle each pixel shows.
#[derive(Clone, Debug)]
pub struct DepthTarget {
    /// Width, pixels; 1 to [`DepthTarget::MAX_SIDE`].
    pub width: u32,
    /// Height, pixels; 1 to [`DepthTarget::MAX_SIDE`].
    pub height: u32,
    /// Which depth survives.
    pub mode: DepthMode,
    /// Depth of every pixel, 0 to 1, row 0 on top.
    pub depth: Vec<f32>,
    /// Index into [`SceneModel::triangles`] of what every pixel shows, or [`NONE`].
    pub triangle: Vec<u32>,
}

impl DepthTarget {
    /// Largest width and height, pixels: what GPUs allow, and small enough for the edge functions (in 1/256 pixel) to
    /// be exact in 64-bit integers with 17 bits to spare.
    pub const MAX_SIDE: u32 = 16_384;

    /// A cleared image of `width` x `height` pixels.
    ///
    /// # Panics
    /// When a side is 0 or above [`DepthTarget::MAX_SIDE`].
    #[must_use]
    pub fn new(width: u32, height: u32, mode: DepthMode) -> Self {
        let legal = 1..=Self::MAX_SIDE;
        assert!(
            legal.contains(&width) && legal.contains(&height),
            "depth target of {width} x {height} pixels: each side must be 1 to {}",
            Self::MAX_SIDE
        );
        let pixels = width as usize * height as usize;
        Self { width, height, mode, depth: vec![mode.cleared(); pixels], triangle: vec![NONE; pixels] }
    }

    /// Forgets everything drawn.
    pub fn clear(&mut self) {
        self.depth.fill(self.mode.cleared());
        self.triangle.fill(NONE);
    }
}

/// How the triangles of a scene reach the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterPass {
    /// Clip coordinates from render space (world - origin): x, y in [-w, w], z in [0, w].
    pub clip_from_render: Mat4,
    /// When given, a pixel stores the dot product of this row with the surface point (x, y, z, 1) of render space, held
    /// to 0..1, instead of clip z/w. Clipping still follows clip z.
    pub depth_from_render: Option<Vec4>,
    /// Origin of render space in the world.
    pub origin: DVec3,
}

/// What became of the triangles given to [`rasterise`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rasterised {
    /// Triangles that were looked at.
    pub submitted: usize,
    /// Triangles skipped because a clip coordinate was not a finite number; 0 for finite matrices and positions.
    pub not_finite: usize,
}

/// Draws the triangles of `ranges` (in order) into `target`, on top of what it holds.
///
/// # Panics
/// When a range or an index of the model points outside the model's lists.
pub fn rasterise(
    target: &mut DepthTarget,
    model: &SceneModel,
    ranges: &[Range<usize>],
    pass: &RasterPass,
) -> Rasterised {
    // Transform, clip and snap the triangles, chunk by chunk
    let chunks: Vec<Setup> = split_ranges(ranges)
        .into_par_iter()
        .map(|chunk| Setup::new(model, chunk, pass, target.width, target.height))
        .collect();

    // Fill bands of rows; each band walks all chunks in order, so that threads never race for a pixel
    let width = target.width as usize;
    let mode = target.mode;
    let band = BAND_ROWS * width;
    let depths = target.depth.par_chunks_mut(band);
    let triangles = target.triangle.par_chunks_mut(band);
    depths.zip(triangles).enumerate().for_each(|(index, (depth, triangle))| {
        let first_row = index * BAND_ROWS;
        Band { first_row, rows: depth.len() / width, width, mode, depth, triangle }.fill(model, &chunks);
    });

    Rasterised {
        submitted: ranges.iter().map(ExactSizeIterator::len).sum(),
        not_finite: chunks.iter().map(|chunk| chunk.not_finite).sum(),
    }
}

fn split_ranges(ranges: &[Range<usize>]) -> Vec<Range<usize>> {
    let pieces = |range: &Range<usize>| {
        let end = range.end;
        range.clone().step_by(SETUP_CHUNK).map(move |start| start..end.min(start + SETUP_CHUNK))
    };
    ranges.iter().flat_map(pieces).collect()
}

/// The rows of the target that one task owns.
struct Band<'a> {
    first_row: usize,
    rows: usize,
    width: usize,
    mode: DepthMode,
    depth: &'a mut [f32],
    triangle: &'a mut [u32],
}

impl Band<'_> {
    fn fill(&mut self, model: &SceneModel, chunks: &[Setup]) {
        let (first, end) = (self.first_row, self.first_row + self.rows);
        for chunk in chunks {
            for (rows, triangle) in chunk.rows.iter().zip(&chunk.triangles) {
                let (top, bottom) = (rows.start as usize, rows.end as usize);
                for row in top.max(first)..bottom.min(end) {
                    self.fill_row(row, triangle, model, chunk);
                }
            }
        }
    }

    fn fill_row(&mut self, row: usize, triangle: &ScreenTriangle, model: &SceneModel, chunk: &Setup) {
        let (start, end) = triangle.columns_of_row(row);
        let base = (row - self.first_row) * self.width;
        let varyings = triangle.varyings.map(|index| &chunk.varyings[index as usize]);
        for column in start..end {
            // Keep the pixel when it is no hole of a cut-out and nearer than what is stored
            let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
            let depth = match varyings {
                None => triangle.depth_at(x, y),
                Some(varyings) => match varying_depth(triangle, varyings, model, x, y) {
                    Some(depth) => depth,
                    None => continue,
                },
            };
            let pixel = base + column;
            if self.mode.passes(depth, self.depth[pixel]) {
                self.depth[pixel] = depth;
                self.triangle[pixel] = triangle.id;
            }
        }
    }
}

/// Depth of a pixel of a triangle that carries varyings; `None` in a hole of its cut-out.
fn varying_depth(triangle: &ScreenTriangle, varyings: &Varyings, model: &SceneModel, x: f64, y: f64) -> Option<f32> {
    let w = 1.0 / varyings.reciprocal_w.at(x, y);
    if let Some(cutout) = varyings.cutout {
        let uv = [varyings.u.at(x, y) * w, varyings.v.at(x, y) * w];
        let cutout = &model.cutouts[cutout as usize];
        if bilinear_alpha(cutout, uv) < cutout.cutoff {
            return None;
        }
    }
    Some(match &varyings.depth {
        Some(plane) => ((plane.at(x, y) * w) as f32).clamp(0.0, 1.0),
        None => triangle.depth_at(x, y),
    })
}

/// Alpha (0..1) at `uv`, filtered between the four nearest texels, the mask repeating beyond 0..1.
fn bilinear_alpha(cutout: &Cutout, uv: [f64; 2]) -> f32 {
    let axis = |coordinate: f64, texels: u32| {
        let position = coordinate.rem_euclid(1.0) * f64::from(texels) - 0.5;
        let low = position.floor();
        let wrap = |texel: f64| texel.rem_euclid(f64::from(texels)) as usize;
        (wrap(low), wrap(low + 1.0), (position - low) as f32)
    };
    let (left, right, x) = axis(uv[0], cutout.width);
    let (top, bottom, y) = axis(uv[1], cutout.height);
    let texel = |row: usize, column: usize| f32::from(cutout.alpha[row * cutout.width as usize + column]) / 255.0;
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(texel(top, left), texel(top, right), x), mix(texel(bottom, left), texel(bottom, right), x), y)
}

#[cfg(test)]
#[allow(
    clippy::cast_lossless,
    clippy::float_cmp,
    clippy::many_single_char_names,
    reason = "corners are a, b, c; cleared depths are exact"
)]
mod tests;
