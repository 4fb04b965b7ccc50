//! Several maps: the Rust twins of `shaders/select_*.wgsl`, `map_many.wgsl`,
//! `visibility_many.wgsl` and `visibility_grazed.wgsl`.
//!
//! Each function has the name and the arithmetic of its shader twin, in f32, operation by operation. The software
//! renderer of the lab runs on them.
//!
//! # References
//! - Engel, *Cascaded shadow maps*, `ShaderX5`, 2006 (by depth); Valient, *Stable rendering of cascaded shadow maps*,
//!   `ShaderX6`, 2008 (by containment: the finest map that holds the point).

use glam::{IVec2, UVec2, UVec4, Vec2, Vec3, Vec4};

use super::depth::{CompareMap, Lookup, antumbra_look_noisy, antumbra_visible_noisy};
use super::grazing::{ANTUMBRA_GRAZED, antumbra_grazing};
use super::read::antumbra_filtered;
use crate::frame::{MAX_VIEWS, Select, ShadowUniforms, ViewUniforms, WgslKey};

/// A map among others in its layer: lookups beyond it read the texels at its rim.
///
/// Twin of `antumbra_on_map`, and of `antumbra_sample` for several maps.
#[derive(Clone, Copy, Debug)]
pub struct OnMap<'a, M> {
    layer: &'a M,
    low: Vec2,
    high: Vec2,
}

impl<'a, M: CompareMap> OnMap<'a, M> {
    /// The map of a view, among `layers`; `None` for layers that there are not.
    #[must_use]
    pub fn of(view: &ViewUniforms, layers: &'a [M]) -> Option<Self> {
        let [left, top, right, bottom] = view.rect;
        let half = 0.5 * view.bias[3];
        let layer = layers.get(view.across_u[3] as usize)?;
        Some(Self { layer, low: Vec2::new(left, top) - half, high: Vec2::new(right, bottom) + half })
    }
}

impl<M: CompareMap> CompareMap for OnMap<'_, M> {
    fn size(&self) -> UVec2 {
        self.layer.size()
    }

    fn sample_compare(&self, uv: Vec2, depth: f32) -> f32 {
        self.layer.sample_compare(uv.max(self.low).min(self.high), depth)
    }

    fn depth(&self, texel: Vec2) -> f32 {
        let size = self.size().as_vec2();
        let (low, high) = ((self.low * size).floor().max(Vec2::ZERO), (self.high * size).floor().min(size - 1.0));
        self.layer.depth(texel.max(low).min(high))
    }

    fn stored(&self, uv: Vec2, level: f32, pair: u32) -> Vec4 {
        let rim = antumbra_rim(self.size(), level);
        self.layer.stored(uv.max(self.low + rim).min(self.high - rim), level, pair)
    }

    fn sum(&self, texel: IVec2) -> UVec4 {
        self.layer.sum(texel)
    }
}

/// Twin of `antumbra_rim`: from the centres of the outermost texels of a map to those of the smaller level that is
/// read, or of the smaller one of two, texture coordinates. Levels are 0 to 31, `size` is that of level 0.
#[must_use]
pub fn antumbra_rim(size: UVec2, level: f32) -> Vec2 {
    0.5 * ((1_u32 << (level.ceil() as u32).min(31)) - 1) as f32 / size.as_vec2()
}

/// Twin of `antumbra_visibility`: share of the light that reaches a point of render space. A view whose layer is not
/// among `layers` reads lit.
#[must_use]
pub fn antumbra_visibility<M: CompareMap>(
    key: WgslKey,
    uniforms: &ShadowUniforms,
    layers: &[M],
    position: Vec3,
    normal: Vec3,
    view_depth: f32,
) -> f32 {
    antumbra_visibility_noisy(key, uniforms, layers, position, normal, view_depth, 0.0)
}

/// Twin of `antumbra_visibility_noisy`: the same by a filter whose disc is turned by `noise`, 0 to 1.
#[must_use]
pub fn antumbra_visibility_noisy<M: CompareMap>(
    key: WgslKey,
    uniforms: &ShadowUniforms,
    layers: &[M],
    position: Vec3,
    normal: Vec3,
    view_depth: f32,
    noise: f32,
) -> f32 {
    let row = Vec4::from_array(uniforms.views[0].depth_from_render);
    let grazed = antumbra_grazing(key.grazing, normal, row);
    if grazed >= 1.0 {
        return ANTUMBRA_GRAZED;
    }
    let lit = antumbra_mapped(key, uniforms, layers, position, normal, view_depth, noise);
    lit * (1.0 - grazed) + ANTUMBRA_GRAZED * grazed
}

/// Twin of `antumbra_mapped`: what maps say, without a rule for grazing light.
fn antumbra_mapped<M: CompareMap>(
    key: WgslKey,
    uniforms: &ShadowUniforms,
    layers: &[M],
    position: Vec3,
    normal: Vec3,
    view_depth: f32,
    noise: f32,
) -> f32 {
    let last = usize::from(key.maps).clamp(1, MAX_VIEWS) - 1;
    if last == 0 {
        let visible = |map| antumbra_visible_noisy(key, &uniforms.views[0], map, position, normal, noise);
        return layers.first().map_or(1.0, visible);
    }
    if key.select == Select::Finest {
        return finest(key, uniforms, layers, last, &Receiver { position, normal, view_depth, noise });
    }
    let visible = |index: usize| {
        let view = &uniforms.views[index];
        OnMap::of(view, layers).map_or(1.0, |map| antumbra_visible_noisy(key, view, &map, position, normal, noise))
    };
    let index = antumbra_index(uniforms, last, view_depth);
    let lit = visible(index);
    let [.., from, per_depth] = uniforms.views[index].domain;
    let share = ((view_depth - from) * per_depth).clamp(0.0, 1.0);
    if !key.blend || share == 0.0 {
        return lit;
    }
    let next = if index < last { visible(index + 1) } else { 1.0 };
    // As `mix` is defined.
    lit * (1.0 - share) + next * share
}

/// Twin of `antumbra_index`: the first map whose depths hold the receiver; `last` is the last of all.
#[must_use]
pub fn antumbra_index(uniforms: &ShadowUniforms, last: usize, view_depth: f32) -> usize {
    uniforms.views[..last].iter().filter(|view| view_depth > view.domain[1]).count()
}

/// Twin of `antumbra_room`: texture coordinates from a place in a map to the nearest rim of what may be looked up
/// there.
#[must_use]
pub fn antumbra_room(view: &ViewUniforms, look: &Lookup) -> f32 {
    let [left, top, right, bottom] = view.rect;
    let room = (look.uv - Vec2::new(left, top)).min(Vec2::new(right, bottom) - look.uv) - view.domain[2];
    if look.depth <= 1.0 - view.domain[2].min(0.0) { room.x.min(room.y) } else { -1.0 }
}

/// What is looked up.
struct Receiver {
    position: Vec3,
    normal: Vec3,
    view_depth: f32,
    noise: f32,
}

/// The loop over maps of `select_finest*.wgsl`.
fn finest<M: CompareMap>(
    key: WgslKey,
    uniforms: &ShadowUniforms,
    layers: &[M],
    last: usize,
    &Receiver { position, normal, view_depth, noise }: &Receiver,
) -> f32 {
    let (mut lit, mut rest) = (0.0, 1.0);
    for view in &uniforms.views[..=last] {
        let look = antumbra_look_noisy(key, view, position, normal, noise);
        let room = antumbra_room(view, &look);
        if room < 0.0 {
            continue;
        }
        let share = if key.blend { rest * (room * view.domain[3]).min(1.0) } else { rest };
        lit += share * OnMap::of(view, layers).map_or(1.0, |map| antumbra_filtered(key, view, &map, &look, position));
        rest -= share;
        if rest <= 0.0 {
            break;
        }
    }
    let visibility = if rest < 1.0 { lit / (1.0 - rest) } else { 1.0 };
    if !key.blend {
        return visibility;
    }
    let fade = (view_depth - uniforms.views[0].across_v[3]) * uniforms.views[0].across_w[3];
    let fade = fade.clamp(0.0, 1.0);
    visibility * (1.0 - fade) + fade
}
