//! The blur of a picture's shadow term, in software: the passes of [`gpu::ScreenBlur`](crate::gpu::ScreenBlur), pixel
//! by pixel.

use glam::{IVec2, UVec2};
use rayon::prelude::*;

use crate::encoding::eye_blur::{EyeBlurUniforms, antumbra_eye_blur_along};

/// A shadow term (0 to 1) after `iterations` of a blur; `mask` and `depth` are of `size` pixels, row 0 on top.
///
/// # Panics
/// When they are not.
#[must_use]
pub fn blur(blur: &EyeBlurUniforms, iterations: u32, size: UVec2, mask: &[f32], depth: &[f32]) -> Vec<f32> {
    let count = size.x as usize * size.y as usize;
    assert!(mask.len() == count && depth.len() == count, "a value for each of {count} pixels");
    let mut mask = mask.to_vec();
    for _ in 0..iterations {
        for axis in [IVec2::X, IVec2::Y] {
            let width = size.x as usize;
            let at = |values: &[f32], pixel: IVec2| values[pixel.y as usize * width + pixel.x as usize];
            let along = |index: usize| {
                let pixel = UVec2::new((index % width) as u32, (index / width) as u32).as_ivec2();
                let (source, depth) = (|other| at(&mask, other), |other| at(depth, other));
                antumbra_eye_blur_along(blur, size.as_ivec2(), pixel, axis, source, depth)
            };
            mask = (0..count).into_par_iter().map(along).collect();
        }
    }
    mask
}
