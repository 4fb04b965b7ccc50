//! Maps of moments, stored and read: the Rust twins of `shaders/store_*.wgsl`, `read_*.wgsl` and `level_*.wgsl`.
//!
//! # References
//! - Williams, *Pyramidal parametrics*, 1983 (levels of a mip chain).
//! - `MATH.md` section 7; the papers of each kind of moments stand in its own file.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::convolution::{antumbra_convolution_lit, antumbra_convolution_part, antumbra_convolution_terms};
use super::depth::{CompareMap, Lookup, antumbra_filter};
use super::exponential::{
    antumbra_exponential_lit, antumbra_exponential_moments, antumbra_exponential_variance_lit,
    antumbra_exponential_variance_lit_two, antumbra_exponential_variance_moments,
};
use super::moments::{
    antumbra_moments, antumbra_moments_lit, antumbra_moments_lit_within, antumbra_moments_packed,
    antumbra_moments_unpacked,
};
use super::summed::{antumbra_half_widths, antumbra_summed};
use super::variance::{
    antumbra_darkened, antumbra_variance_lit, antumbra_variance_moments, antumbra_variance_packed,
    antumbra_variance_unpacked,
};
use crate::frame::{ViewUniforms, WgslKey};
use crate::texel::{CONVOLUTION_TERMS, MomentKind, Moments, Texel};

/// Twin of the shader's constant: below every w in view.
const ANTUMBRA_LEVEL_SMALLEST: f32 = 1e-6;

/// Twin of `antumbra_store`: what a texel stores of a depth; for a series, of `first_term` and the next one.
#[must_use]
pub fn antumbra_store(moments: Moments, depth: f32, first_term: u32) -> Vec4 {
    let packed = moments.format().is_packed();
    match moments.kind() {
        MomentKind::Variance => {
            let two = antumbra_variance_moments(depth);
            let two = if packed { antumbra_variance_packed(two) } else { two };
            two.extend(0.0).extend(0.0)
        }
        MomentKind::Exponential => Vec4::X * antumbra_exponential_moments(depth),
        MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour => {
            antumbra_exponential_variance_moments(depth, moments.exponents().into())
        }
        MomentKind::Convolution => antumbra_convolution_terms(depth, first_term) * 0.5 + 0.5,
        MomentKind::Hamburger | MomentKind::Hausdorff if packed => antumbra_moments_packed(antumbra_moments(depth)),
        MomentKind::Hamburger | MomentKind::Hausdorff => antumbra_moments(depth),
    }
}

/// Twin of `antumbra_read`: share of the light at a depth by what is stored, 0 to 1. Not for a series.
#[must_use]
pub fn antumbra_read(moments: Moments, stored: Vec4, depth: f32, slope: Vec2) -> f32 {
    let packed = moments.format().is_packed();
    let two = || if packed { antumbra_variance_unpacked(stored.xy()) } else { stored.xy() };
    let four = || if packed { antumbra_moments_unpacked(stored) } else { stored };
    let exponents = moments.exponents().into();
    let blur = || moments.blur() + 0.5 * slope.length();
    match moments.kind() {
        MomentKind::Variance => antumbra_variance_lit(two(), depth, moments.variance_loss() + 0.25 * slope.dot(slope)),
        MomentKind::Exponential => antumbra_exponential_lit(stored.x, depth, moments.exponent()),
        MomentKind::ExponentialVarianceTwo => {
            antumbra_exponential_variance_lit_two(stored.xy(), depth, exponents, blur())
        }
        MomentKind::ExponentialVarianceFour => antumbra_exponential_variance_lit(stored, depth, exponents, blur()),
        MomentKind::Convolution => 1.0,
        MomentKind::Hamburger => antumbra_moments_lit(four(), depth, moments.moment_bias()),
        MomentKind::Hausdorff => antumbra_moments_lit_within(four(), depth, moments.moment_bias()),
    }
}

/// Twin of `antumbra_level`: level of the mip chain that a receiver is looked up in.
#[must_use]
pub fn antumbra_level(moments: Moments, view: &ViewUniforms, position: Vec3) -> f32 {
    if !moments.mips {
        return 0.0;
    }
    let at = position.extend(1.0);
    let w = Vec4::from_array(view.w_from_render).dot(at).max(ANTUMBRA_LEVEL_SMALLEST);
    let texels = Vec4::from_array(view.pixel_from_render).dot(at) / (w * w.sqrt());
    texels.max(1.0).log2().clamp(0.0, view.moments[1])
}

/// Twin of `antumbra_filter`, for whatever texels store.
#[must_use]
pub fn antumbra_filtered(
    key: WgslKey,
    view: &ViewUniforms,
    map: &impl CompareMap,
    look: &Lookup,
    position: Vec3,
) -> f32 {
    let Texel::Moments(moments) = key.texel else { return antumbra_filter(key.filter, map, look) };
    let (depth, level) = (look.depth.clamp(0.0, 1.0), antumbra_level(moments, view, position));
    let lit = if moments.kind() == MomentKind::Convolution {
        let part = |term: u32| {
            let terms = map.stored(look.uv, level, term / 2) * 2.0 - 1.0;
            antumbra_convolution_part(terms, depth, term)
        };
        antumbra_convolution_lit((0..CONVOLUTION_TERMS).step_by(2).fold(0.5, |sum, term| sum + part(term)))
    } else if moments.is_summed() {
        let stored = antumbra_summed(map, view, look.uv, antumbra_half_widths(view, position, look.uv));
        antumbra_read(moments, stored, depth, look.slope)
    } else {
        antumbra_read(moments, map.stored(look.uv, level, 0), depth, look.slope)
    };
    // Nothing is nearer, whatever is stored: maps that were never drawn are lit.
    if look.depth < 0.0 { 1.0 } else { antumbra_darkened(lit, view.moments[0]) }
}
