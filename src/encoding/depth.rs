//! Depth maps: the Rust twins of `shaders/lookup.wgsl`, `lookup_projective.wgsl`, `look_*.wgsl`, `visibility_one.wgsl`
//! and `caster.wgsl`.
//!
//! Each function has the name and the arithmetic of its shader twin, in f32, operation by operation; `tests/twins`
//! holds them together on an adapter. The software renderer of the lab runs on them.
//!
//! # References
//! - Reeves, Salesin & Cook, *Rendering antialiased shadows with depth maps*, 1987 (percentage-closer filtering).
//! - `MATH.md` section 7.

use glam::{IVec2, UVec2, UVec4, Vec2, Vec3, Vec4, Vec4Swizzles};

pub use super::pcf::{antumbra_box_row, antumbra_filter, antumbra_tap};
use super::read::{antumbra_filtered, antumbra_level};
use super::spread::{Spread, antumbra_spread};
use crate::frame::{MapShape, Pcf, ViewUniforms, WgslKey};
use crate::texel::Texel;

/// A depth map that can be compared with, as a comparison sampler does it.
pub trait CompareMap {
    /// Size in texels.
    fn size(&self) -> UVec2;
    /// Bilinear share of the four texels around `uv` whose depth is at least `depth`; coordinates clamp to the edge.
    fn sample_compare(&self, uv: Vec2, depth: f32) -> f32;
    /// The depth in a texel, by its number along u and v; beyond the map it is that at its rim. Maps of moments have
    /// none.
    fn depth(&self, texel: Vec2) -> f32 {
        let _ = texel;
        1.0
    }
    /// What is stored around `uv` at a level of the mip chain, interpolated; of a series, the `pair`th two terms. Maps
    /// of depths store none.
    fn stored(&self, uv: Vec2, level: f32, pair: u32) -> Vec4 {
        let _ = (uv, level, pair);
        Vec4::ZERO
    }
    /// The sum in a texel, by its number along u and v; beyond the map it is that at its rim. Other maps have none.
    fn sum(&self, texel: IVec2) -> UVec4 {
        let _ = texel;
        UVec4::ZERO
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
        let lit = |dx: f32, dy: f32| if depth <= self.depth(base + Vec2::new(dx, dy)) { 1.0 } else { 0.0 };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let above = mix(lit(0.0, 0.0), lit(1.0, 0.0), fraction.x);
        let below = mix(lit(0.0, 1.0), lit(1.0, 1.0), fraction.x);
        mix(above, below, fraction.y)
    }

    fn depth(&self, texel: Vec2) -> f32 {
        // Clamped before it is narrowed: hostile coordinates do not fit an integer.
        let texel = texel.clamp(Vec2::ZERO, self.size.as_vec2() - 1.0).as_uvec2();
        self.depth[(texel.y * self.size.x + texel.x) as usize]
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
    /// How taps are spread around it, for filters whose taps lie on a disc; others do not read it.
    pub spread: Spread,
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
        spread: Spread::default(),
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
        spread: Spread::default(),
    }
}

/// Twin of `antumbra_visible`: share of the light that reaches a point of render space.
#[must_use]
pub fn antumbra_visible(key: WgslKey, view: &ViewUniforms, map: &impl CompareMap, position: Vec3, normal: Vec3) -> f32 {
    antumbra_visible_noisy(key, view, map, position, normal, 0.0)
}

/// Twin of `antumbra_visible_noisy`: the same by a filter whose disc is turned by `noise`, 0 to 1.
#[must_use]
pub fn antumbra_visible_noisy(
    key: WgslKey,
    view: &ViewUniforms,
    map: &impl CompareMap,
    position: Vec3,
    normal: Vec3,
    noise: f32,
) -> f32 {
    antumbra_filtered(key, view, map, &antumbra_look_noisy(key, view, position, normal, noise), position)
}

/// Twin of `antumbra_look`: where a receiver is looked up in a view, its bias applied.
#[must_use]
pub fn antumbra_look(key: WgslKey, view: &ViewUniforms, position: Vec3, normal: Vec3) -> Lookup {
    antumbra_look_noisy(key, view, position, normal, 0.0)
}

/// Twin of `antumbra_look_noisy`: the same for a filter whose disc is turned by `noise`, 0 to 1.
#[must_use]
pub fn antumbra_look_noisy(key: WgslKey, view: &ViewUniforms, position: Vec3, normal: Vec3, noise: f32) -> Lookup {
    let wider = match key.texel {
        Texel::Moments(moments) => view.moments[2] * (antumbra_level(moments, view, position).exp2() - 1.0),
        Texel::Depth => 0.0,
    };
    let (reach, tap_reach) = (key.filter.reach() as f32 + wider, key.filter.tap_reach() as f32 + wider);
    let lookup = |reach| match key.shape {
        MapShape::Affine => antumbra_lookup(view, position, normal, reach, tap_reach),
        shape => antumbra_lookup_projective(shape, view, position, normal, reach, tap_reach),
    };
    let (look, mut spread) = (lookup(reach), antumbra_spread(key, view, position, normal, noise));
    if key.filter == Pcf::Pcss {
        let near = lookup(tap_reach);
        let depth = if key.shape == MapShape::Affine { near.depth - look.depth } else { 0.0 };
        spread.back = (near.uv - look.uv).extend(depth) / (reach - tap_reach);
    }
    Lookup { spread, ..look }
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
