//! How far what a GPU stores may be from what memory stores: derived, not measured.
//!
//! A texel is a mean of means of stored values. Let V be the largest of what it is made of.
//! - Sums of n terms, each rounded, and one division (2.5 ulp): n + 4 ulp of V a pass.
//! - Half-widths that are computed from world steps differ by up to 64 ulp (a division, a root, products and one
//!   cancelled difference of at most 4 bits): a box of width 2r changes by that share, and its mean by as much of 2V.
//! - Exponentials are off by 3 + 2|x| ulp, and x by one rounding, |x| ulp: of squares twice that. Sines and cosines are
//!   off by 2⁻¹¹ at most (WGSL, within π), which is more than all else.
//! - A format rounds each pass to a step, and values that lie on its edge to either side: a step a pass, and one for
//!   each level of mips.

use antumbra::lab::moments::MomentMap;
use antumbra::{MomentFormat, MomentKind, Moments};
use glam::{UVec2, Vec4};

/// Ulps of half-widths.
const RADIUS_ULPS: f32 = 64.0;

/// Most terms of a sum.
const TERMS: f32 = 95.0;

/// Passes from depths to what is stored.
const PASSES: f32 = 2.0;

/// Error of a sine or a cosine.
const SINE: f32 = 1.0 / 2048.0;

/// Largest difference between two texels at a level, where `largest` is the greatest magnitude that they are made of,
/// channel by channel.
pub(crate) fn bound(moments: Moments, level: u32, largest: Vec4) -> Vec4 {
    let rounded = PASSES * (RADIUS_ULPS + TERMS + 4.0) + 8.0 * level as f32;
    let exponential = match moments.kind() {
        MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour => {
            2.0 * (3.0 + 3.0 * moments.exponents()[0])
        }
        _ => 0.0,
    };
    let sine = if moments.kind() == MomentKind::Convolution { 0.5 * SINE } else { 0.0 };
    let steps = PASSES + level as f32;
    let step = largest.to_array().map(|largest| step(moments.format(), largest));
    largest * (rounded + exponential) * f32::EPSILON + steps * Vec4::from_array(step) + sine
}

/// Distance between neighbouring numbers of a format.
fn step(format: MomentFormat, largest: f32) -> f32 {
    match format {
        MomentFormat::Float32 => 0.0,
        // Formats may flush what is smaller than 2⁻¹⁴.
        MomentFormat::Float16 => (largest / 1024.0).max(1.0 / 16384.0),
        MomentFormat::Unorm16 | MomentFormat::Summed => 1.0 / 65535.0,
        MomentFormat::Unorm8 => 1.0 / 255.0,
    }
}

/// The same for exponentials, which are stored as logarithms: sums of exponentials relative to the `largest` depth are
/// compared, in which all of the above holds; a step of the format is a factor there.
pub(crate) fn differs(moments: Moments, level: u32, [gpu, cpu]: [f32; 2], largest: f32) -> f32 {
    let exponent = moments.exponent();
    let [gpu, cpu] = [gpu, cpu].map(|depth| (exponent * (depth - largest)).exp());
    let step = if moments.format() == MomentFormat::Float16 { 1.0 / 1024.0 } else { 0.0 };
    let factor = (exponent * ((PASSES + level as f32) * step + 4.0 * f32::EPSILON)).exp() - 1.0;
    let rounded = PASSES * (RADIUS_ULPS + TERMS + 16.0) + 16.0 * level as f32;
    (gpu - cpu).abs() / (gpu.max(cpu) * factor + rounded * f32::EPSILON)
}

/// For each texel the largest magnitude, channel by channel, of anything within reach of it.
pub(crate) fn largest_within(values: &[Vec4], side: usize, reach: usize) -> Vec<Vec4> {
    let along = |values: &[Vec4], stride: usize| -> Vec<Vec4> {
        let place = |index: usize| index / stride % side;
        (0..values.len())
            .map(|index| {
                let (back, forth) = (place(index).min(reach), (side - 1 - place(index)).min(reach));
                let run = (index - back * stride..=index + forth * stride).step_by(stride);
                run.fold(Vec4::ZERO, |largest, index| largest.max(values[index].abs()))
            })
            .collect()
    };
    along(&along(values, 1), side)
}

/// All texels of a level in memory.
pub(crate) fn texels(map: &MomentMap, pair: usize, level: usize, side: usize) -> Vec<Vec4> {
    (0..side * side)
        .map(|index| map.texel(pair, level, UVec2::new((index % side) as u32, (index / side) as u32)))
        .collect()
}
