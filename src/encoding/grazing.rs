//! How much of a visibility the light's angle decides: the Rust twin of `shaders/grazing_*.wgsl`.
//!
//! # References
//! - J. Abrantes de Oliveira, *Analysis and proposal of a shadow mapping remix approach*, Universidade do Minho,
//!   section 4.2.2: between 85° and 90° half of the light arrives, and depths are not compared.
//! - `MATH.md` section 7: the same without a leap.

use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::grazing::Grazing;

/// Twin of the shader's constant: visibility where the rule is for the whole.
pub(super) const ANTUMBRA_GRAZED: f32 = 0.5;

/// Twin of the shader's constant: below every row of a light; keeps a view without one from dividing by zero.
const ANTUMBRA_GRAZING_SMALLEST: f32 = 1e-30;

/// Twin of the shader's constant: cosine of 85 degrees, from which on the printed rule holds.
const ANTUMBRA_GRAZING_COSINE: f32 = 0.087_155_74;

/// Twin of the shader's constant: cosine of 88 degrees, from which on the continuous rule holds for the whole.
const ANTUMBRA_GRAZING_LEAST: f32 = 0.034_899_496;

/// Twin of the shader's constant: cosine of 82 degrees, up to which it does not hold at all.
const ANTUMBRA_GRAZING_MOST: f32 = 0.139_173_1;

/// Twin of `antumbra_grazing`: the share of a receiver's visibility that is a half instead of what maps say, 0 to 1.
///
/// `depth_from_render` is the row of any view of the light. No row and no normal (zeros) give 0.
#[must_use]
pub fn antumbra_grazing(grazing: Grazing, normal: Vec3, depth_from_render: Vec4) -> f32 {
    let scale = depth_from_render.xyz().length();
    let cosine = -depth_from_render.xyz().dot(normal) / scale.max(ANTUMBRA_GRAZING_SMALLEST);
    let is_known = scale > ANTUMBRA_GRAZING_SMALLEST && normal.cmpne(Vec3::ZERO).any();
    match grazing {
        Grazing::Printed if is_known && (0.0..=ANTUMBRA_GRAZING_COSINE).contains(&cosine) => 1.0,
        Grazing::Continuous if is_known => 1.0 - smoothstep(ANTUMBRA_GRAZING_LEAST, ANTUMBRA_GRAZING_MOST, cosine),
        Grazing::Off | Grazing::Printed | Grazing::Continuous => 0.0,
    }
}

/// As WGSL has it.
fn smoothstep(low: f32, high: f32, value: f32) -> f32 {
    let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
