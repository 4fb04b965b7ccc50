//! A blur of the picture's shadow term, after receivers: the Rust twins of `shaders/eye_blur.wgsl`.
//!
//! A bell along rows, then along columns, as often as is wanted. It is as wide in the world at every depth, so that far
//! shadows keep their detail, and takes no pixel from across an edge of depth. What it hides, it hides by averaging:
//! where a map errs the error becomes even, and shadows lose what is narrower than the bell.
//!
//! # References
//! - Scherzer, *Robust shadow maps for large environments*, 2005: 1 to 16 iterations, less with depth.
//! - `MATH.md` section 7: width and edges.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, IVec2, UVec2, Vec2};

use crate::error::{FitError, finite};

/// How wide, and how often.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeBlur {
    /// Standard deviation of one iteration, world units, 0 (no blur) to 1e9. n iterations deviate by √n as much.
    pub radius: f32,
    /// Largest deviation of one iteration, pixels, 0 to 32: near surfaces are blurred by no more.
    pub most: f32,
    /// Eye depth between two pixels, as a multiple of `radius`, from which on they do not mix, 0 to 1e3. Towards 0
    /// slanted surfaces stay sharp, large values bleed over near edges.
    pub edge: f32,
    /// How often it is applied, 1 to 16.
    pub iterations: u32,
}

impl Default for EyeBlur {
    /// 2 cm where a unit is a metre, once.
    fn default() -> Self {
        Self { radius: 0.02, most: 8.0, edge: 4.0, iterations: 1 }
    }
}

/// Largest radius, world units: far beyond use, far below overflow.
const LARGEST_RADIUS: f64 = 1e9;

/// Largest deviation in pixels: 84 pixels to either side.
const MOST_PIXELS: f64 = 32.0;

/// Largest multiple of the radius for an edge.
const MOST_EDGE: f64 = 1e3;

/// Most iterations: those of the paper.
pub(crate) const MOST_ITERATIONS: u32 = 16;

/// What the passes read: upload verbatim. The layout equals `AntumbraEyeBlur` in the shader, member by member.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct EyeBlurUniforms {
    /// Eye depth of a value d of the depth buffer: (x d + y) / (z d + w), world units.
    pub eye_depth: [f32; 4],
    /// w of clip space at an eye depth: x times it, and y. z, w: pixels for a deviation of the bell where w is 1.
    pub pixels: [f32; 4],
    /// Largest deviation, pixels.
    pub most: f32,
    /// Eye depth between pixels that do not mix, world units.
    pub edge: f32,
    /// Nothing.
    pub padding: [f32; 2],
}

impl EyeBlur {
    /// What the passes read, for a camera of that projection and a picture of `size` pixels. Depth is as the buffer
    /// stores it: z of clip space from 0 to w, standard or reversed, with a finite or infinite far plane. (A matrix whose
    /// z goes from −w to w needs half of the sum of its rows z and w for its row z.)
    ///
    /// # Errors
    /// A number outside of its range, or a matrix that is not finite in f32.
    pub fn uniforms(&self, clip_from_view: &DMat4, size: UVec2) -> Result<EyeBlurUniforms, FitError> {
        self.validate()?;
        for entry in clip_from_view.to_cols_array() {
            finite("clip_from_view", f64::from(entry as f32))?;
        }
        let [z, w] = [clip_from_view.row(2), clip_from_view.row(3)];
        let radius = f64::from(self.radius);
        let pixels = |axis: usize, side: u32| clip_from_view.col(axis)[axis].abs() * 0.5 * f64::from(side) * radius;
        Ok(EyeBlurUniforms {
            eye_depth: [w.w, -z.w, w.z, -z.z].map(|entry| entry as f32),
            pixels: [-w.z, w.w, pixels(0, size.x), pixels(1, size.y)].map(|entry| entry as f32),
            most: self.most,
            edge: self.edge * self.radius,
            padding: [0.0; 2],
        })
    }

    /// Whether every number is in its range.
    pub(crate) fn validate(&self) -> Result<(), FitError> {
        let within = |field, value: f64, low: f64, high: f64, legal| {
            let value = finite(field, value)?;
            if (low..=high).contains(&value) { Ok(()) } else { Err(FitError::OutOfRange { field, value, legal }) }
        };
        within("blur.radius", self.radius.into(), 0.0, LARGEST_RADIUS, "0 to 1e9")?;
        within("blur.most", self.most.into(), 0.0, MOST_PIXELS, "0 to 32")?;
        within("blur.edge", self.edge.into(), 0.0, MOST_EDGE, "0 to 1e3")?;
        within("blur.iterations", self.iterations.into(), 1.0, MOST_ITERATIONS.into(), "1 to 16")
    }
}

/// Twin of the shader's constant: beyond every eye depth there is.
const ANTUMBRA_EYE_BLUR_FARTHEST: f32 = 1e30;

/// Twin of the shader's constant: below every divisor of an eye depth.
const ANTUMBRA_EYE_BLUR_SMALLEST: f32 = 1e-30;

/// Twin of the shader's constant: deviations at which a bell ends.
const ANTUMBRA_EYE_BLUR_REACH: f32 = 2.5;

/// Twin of the shader's constant: by how much less a bell deviates that ends there.
const ANTUMBRA_EYE_BLUR_CUT: f32 = 1.0476;

/// Twin of `antumbra_eye_depth`: eye depth of a value of the depth buffer, world units.
#[must_use]
pub fn antumbra_eye_depth(blur: &EyeBlurUniforms, depth: f32) -> f32 {
    let [x, y, z, w] = blur.eye_depth;
    let divisor = z * depth + w;
    if divisor.abs() < ANTUMBRA_EYE_BLUR_SMALLEST {
        return ANTUMBRA_EYE_BLUR_FARTHEST;
    }
    ((x * depth + y) / divisor).min(ANTUMBRA_EYE_BLUR_FARTHEST)
}

/// Twin of `antumbra_eye_blur_deviation`: deviation of the bell at an eye depth, pixels along a row and a column.
#[must_use]
pub fn antumbra_eye_blur_deviation(blur: &EyeBlurUniforms, eye_depth: f32) -> Vec2 {
    let [scale, offset, x, y] = blur.pixels;
    let w = (scale * eye_depth + offset).max(ANTUMBRA_EYE_BLUR_SMALLEST);
    (Vec2::new(x, y) / w).min(Vec2::splat(blur.most))
}

/// Twin of `antumbra_eye_blur_reach`: how many pixels to either side weigh anything.
#[must_use]
pub fn antumbra_eye_blur_reach(deviation: f32) -> i32 {
    (deviation * ANTUMBRA_EYE_BLUR_CUT * ANTUMBRA_EYE_BLUR_REACH - 0.5).ceil() as i32
}

/// Twin of `antumbra_eye_blur_weight`: weight of a pixel at an offset, whose eye depth is that far `apart`.
#[must_use]
pub fn antumbra_eye_blur_weight(blur: &EyeBlurUniforms, offset: f32, deviation: f32, apart: f32) -> f32 {
    let wide = deviation * ANTUMBRA_EYE_BLUR_CUT;
    let share = offset / wide.max(ANTUMBRA_EYE_BLUR_SMALLEST);
    let overlap = (wide * ANTUMBRA_EYE_BLUR_REACH + 0.5 - offset.abs()).clamp(0.0, 1.0);
    if apart.abs() <= blur.edge { (-0.5 * share * share).exp() * overlap } else { 0.0 }
}

/// Twin of `antumbra_eye_blur_along`: the mean around a pixel along a row (1, 0) or a column (0, 1) of a picture, given
/// its shadow term and the depth buffer by pixel.
#[must_use]
pub fn antumbra_eye_blur_along(
    blur: &EyeBlurUniforms,
    size: IVec2,
    pixel: IVec2,
    axis: IVec2,
    source: impl Fn(IVec2) -> f32,
    depth: impl Fn(IVec2) -> f32,
) -> f32 {
    let middle = antumbra_eye_depth(blur, depth(pixel));
    let deviation = antumbra_eye_blur_deviation(blur, middle).dot(axis.as_vec2());
    let (mut sum, mut whole) = (source(pixel), 1.0);
    for step in 1..=antumbra_eye_blur_reach(deviation) {
        for other in [pixel - axis * step, pixel + axis * step] {
            if other.cmplt(IVec2::ZERO).any() || other.cmpge(size).any() {
                continue;
            }
            let apart = antumbra_eye_depth(blur, depth(other)) - middle;
            let weight = antumbra_eye_blur_weight(blur, step as f32, deviation, apart);
            sum += weight * source(other);
            whole += weight;
        }
    }
    sum / whole
}
