//! Depth maps: the Rust twins of `shaders/lookup.wgsl`, `lookup_projective.wgsl`, `look_*.wgsl`, `pcf_*.wgsl`,
//! `visibility_one.wgsl` and `caster.wgsl`.
//!
//! Each function has the name and the arithmetic of its shader twin, in f32, operation by operation; `tests/twins`
//! holds them together on an adapter. The software renderer of the lab runs on them.
//!
//! # References
//! - Reeves, Salesin & Cook, *Rendering antialiased shadows with depth maps*, 1987 (percentage-closer filtering).
//! - `MATH.md` section 7.

use glam::{UVec2, Vec2, Vec3, Vec4, Vec4Swizzles};

use super::read::{antumbra_filtered, antumbra_level};
use crate::frame::{MapShape, Pcf, ViewUniforms, WgslKey};
use crate::texel::Texel;

/// A depth map that can be compared with, as a comparison sampler does it.
pub trait CompareMap {
    /// Size in texels.
    fn size(&self) -> UVec2;
    /// Bilinear share of the four texels around `uv` whose depth is at least `depth`; coordinates clamp to the edge.
    fn sample_compare(&self, uv: Vec2, depth: f32) -> f32;
    /// What is stored around `uv` at a level of the mip chain, interpolated; of a series, the `pair`th two terms. Maps of
    /// depths store none.
    fn stored(&self, uv: Vec2, level: f32, pair: u32) -> Vec4 {
        let _ = (uv, level, pair);
        Vec4::ZERO
    }
}

/// A depth map in memory: row 0 on top, depth 0 nearest to the light.
#[derive(Clone, Copy, Debug)]
pub struct DepthMap<'a> {
    /// Size in texels.
    pub size: UVec2,
    /// Depths in [0, 1], row by row.
    pub depth: &'a [f32],
}

impl CompareMap for DepthMap<'_> {
    fn size(&self) -> UVec2 {
        self.size
    }

    fn sample_compare(&self, uv: Vec2, depth: f32) -> f32 {
        let at = uv * self.size.as_vec2() - 0.5;
        let base = at.floor();
        // Samplers keep eight bits of the fraction.
        let fraction = ((at - base) * SUB_TEXELS).round() / SUB_TEXELS;
        let last = self.size.as_vec2() - 1.0;
        let lit = |dx: f32, dy: f32| {
            // Clamped before it is narrowed: hostile coordinates do not fit an integer.
            let texel = (base + Vec2::new(dx, dy)).clamp(Vec2::ZERO, last).as_uvec2();
            let stored = self.depth[(texel.y * self.size.x + texel.x) as usize];
            if depth <= stored { 1.0 } else { 0.0 }
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let above = mix(lit(0.0, 0.0), lit(1.0, 0.0), fraction.x);
        let below = mix(lit(0.0, 1.0), lit(1.0, 1.0), fraction.x);
        mix(above, below, fraction.y)
    }
}

/// Steps between texels that samplers resolve (8 bits, the least that Vulkan and Direct3D 12 require).
const SUB_TEXELS: f32 = 256.0;

/// Where to look, and what to compare with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// Texture coordinates.
    pub uv: Vec2,
    /// Light depth of the receiver after its bias.
    pub depth: f32,
    /// Change of that depth over one texel step in u and in v, along the receiver's plane.
    pub slope: Vec2,
}

/// Twin of `antumbra_lookup`.
#[must_use]
pub fn antumbra_lookup(view: &ViewUniforms, position: Vec3, normal: Vec3, reach: f32, tap_reach: f32) -> Lookup {
    let [u, v, depth] = [view.u_from_render, view.v_from_render, view.depth_from_render].map(Vec4::from_array);
    let [fall_u, fall_v, depth_squared, grazing] = view.texel;
    let [lost_reach, manual, ..] = view.bias;
    let climb = Vec2::new(u.xyz().dot(normal), v.xyz().dot(normal));
    let fall = climb * Vec2::new(fall_u, fall_v);
    let step = fall.x.abs() + fall.y.abs();
    let cosine = -depth.xyz().dot(normal);
    let inverse = 1.0 / cosine.abs().max(grazing);
    let along_normal = (reach + lost_reach) * step * (1.0 - cosine.abs() * inverse) + manual;
    let signed = if cosine >= 0.0 { depth_squared } else { -depth_squared };
    let depth_per_fall = signed * inverse;
    let at = position.extend(1.0);
    let lift = cosine * along_normal + (tap_reach + lost_reach) * step * depth_per_fall;
    Lookup {
        uv: Vec2::new(u.dot(at), v.dot(at)) + climb * along_normal,
        depth: depth.dot(at) - lift,
        slope: fall * depth_per_fall,
    }
}

/// Twin of the shader's constant: a texel may outgrow what lies within reach by half.
const ANTUMBRA_MOST_GROWTH: f32 = 0.5;

/// Twin of the shader's constant: (1 + √2)/2, rounded up, texels of shift for each texel of reach.
const ANTUMBRA_MOST_SHIFT: f32 = 1.2072;

/// Twin of the shader's constant: below every fall there is.
const ANTUMBRA_SMALLEST: f32 = 1e-37;

/// Twin of `antumbra_law`: what a depth is multiplied by before it is compared.
#[must_use]
pub fn antumbra_law(shape: MapShape, w: f32) -> f32 {
    match shape {
        MapShape::Affine | MapShape::Projective => 1.0,
        MapShape::ProjectiveDepth => 1.0 / w,
    }
}

/// Twin of `antumbra_lookup_projective`.
#[must_use]
pub fn antumbra_lookup_projective(
    shape: MapShape,
    view: &ViewUniforms,
    position: Vec3,
    normal: Vec3,
    reach: f32,
    tap_reach: f32,
) -> Lookup {
    let [u_row, v_row, w_row, depth] =
        [view.u_from_render, view.v_from_render, view.w_from_render, view.depth_from_render].map(Vec4::from_array);
    let [across_u, across_v, across_w] =
        [view.across_u, view.across_v, view.across_w].map(|row| Vec4::from_array(row).xyz());
    let [_, _, depth_squared, grazing] = view.texel;
    let [lost_reach, manual, growth, texel] = view.bias;
    let at = (position + normal * manual).extend(1.0);
    let w = w_row.dot(at);
    let inside = w > 0.0;
    let from_w = if inside { 1.0 / w } else { 0.0 };
    let uv = Vec2::new(u_row.dot(at), v_row.dot(at)) * from_w;
    let shared_fall = across_w.dot(normal);
    let fall = w * w * Vec2::new(across_v.dot(normal) - uv.y * shared_fall, uv.x * shared_fall - across_u.dot(normal));
    let step = fall.x.abs() + fall.y.abs();
    let cosine = -depth.xyz().dot(normal);
    let inverse = 1.0 / cosine.abs().max(grazing);
    let across = 1.0 - cosine.abs() * inverse;
    let wide = reach + lost_reach;
    let up = fall / fall.x.abs().max(fall.y.abs()).max(ANTUMBRA_SMALLEST);
    let shift = up * (wide * across * (up.x.abs() + up.y.abs()) / up.dot(up).max(1.0));
    let growth = (wide * (1.0 + across * ANTUMBRA_MOST_SHIFT) * growth * w.abs()).min(ANTUMBRA_MOST_GROWTH);
    let signed = if cosine >= 0.0 { depth_squared } else { -depth_squared };
    let depth_per_fall = signed * inverse;
    let lift = (tap_reach + lost_reach + reach * growth) / (1.0 - growth) * step * depth_per_fall;
    let law = antumbra_law(shape, if inside { w / (1.0 - growth) } else { 1.0 });
    Lookup {
        uv: uv + shift * texel,
        depth: if inside { (depth.dot(at) - lift) * law } else { -1.0 },
        slope: fall * depth_per_fall * law,
    }
}

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
        Pcf::Box3x3 => {
            let f = fraction(look.uv, size);
            let first = 1.0 / (2.0 - f) - 1.0 - f;
            let last = f / (1.0 + f) + 1.0 - f;
            let lower = antumbra_tap(map, look, first) * (2.0 - f.x)
                + antumbra_tap(map, look, Vec2::new(last.x, first.y)) * (1.0 + f.x);
            let upper = antumbra_tap(map, look, Vec2::new(first.x, last.y)) * (2.0 - f.x)
                + antumbra_tap(map, look, last) * (1.0 + f.x);
            (lower * (2.0 - f.y) + upper * (1.0 + f.y)) / 9.0
        }
        Pcf::Box5x5 => {
            let f = fraction(look.uv, size);
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
    }
}

/// Twin of `antumbra_box_row`: three taps of a row.
#[must_use]
pub fn antumbra_box_row(map: &impl CompareMap, look: &Lookup, x: Vec3, weight: Vec3, y: f32) -> f32 {
    antumbra_tap(map, look, Vec2::new(x.x, y)) * weight.x
        + antumbra_tap(map, look, Vec2::new(x.y, y)) * weight.y
        + antumbra_tap(map, look, Vec2::new(x.z, y)) * weight.z
}

/// Twin of `antumbra_visible`: share of the light that reaches a point of render space.
#[must_use]
pub fn antumbra_visible(key: WgslKey, view: &ViewUniforms, map: &impl CompareMap, position: Vec3, normal: Vec3) -> f32 {
    antumbra_filtered(key, view, map, &antumbra_look(key, view, position, normal), position)
}

/// Twin of `antumbra_look`: where a receiver is looked up in a view, its bias applied.
#[must_use]
pub fn antumbra_look(key: WgslKey, view: &ViewUniforms, position: Vec3, normal: Vec3) -> Lookup {
    let wider = match key.texel {
        Texel::Moments(moments) => view.moments[2] * (antumbra_level(moments, view, position).exp2() - 1.0),
        Texel::Depth => 0.0,
    };
    let (reach, tap_reach) = (key.filter.reach() as f32 + wider, key.filter.tap_reach() as f32 + wider);
    match key.shape {
        MapShape::Affine => antumbra_lookup(view, position, normal, reach, tap_reach),
        shape => antumbra_lookup_projective(shape, view, position, normal, reach, tap_reach),
    }
}

/// Place of a point between texel centres.
fn fraction(uv: Vec2, size: Vec2) -> Vec2 {
    let at = uv * size - 0.5;
    at - at.floor()
}

/// Twin of `antumbra_caster_depth`.
#[must_use]
pub fn antumbra_caster_depth(depth_from_render: Vec4, position: Vec3) -> f32 {
    depth_from_render.dot(position.extend(1.0))
}

/// Twin of `antumbra_caster`.
#[must_use]
pub fn antumbra_caster(clip_from_render: glam::Mat4, position: Vec3) -> Vec4 {
    clip_from_render * position.extend(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
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
        fn filters_average(u in 0.3..0.7_f32, v in 0.3..0.7_f32, index in 0..4_usize) {
            let filter = Pcf::ALL[index];
            let mut depth = Vec::new();
            let map = half_map(&mut depth);
            let at = |depth| antumbra_filter(filter, &map, &Lookup { uv: Vec2::new(u, v), depth, slope: Vec2::ZERO });
            prop_assert!((at(0.1) - 1.0).abs() < 1e-5);
            prop_assert!(at(0.9).abs() < 1e-5);
            let width = match filter { Pcf::Point => 1e-6, Pcf::Hardware2x2 => 1.0, Pcf::Box3x3 => 3.0, Pcf::Box5x5 => 5.0 };
            let expected = ((u * 16.0 - 8.0) / width + 0.5).clamp(0.0, 1.0);
            // Samplers keep 8 bits of the position between texels.
            if filter != Pcf::Point || (u * 16.0 - 8.0).abs() > 1e-3 {
                prop_assert!((at(0.5) - expected).abs() < 0.01, "{} {}", at(0.5), expected);
            }
        }
    }
}
