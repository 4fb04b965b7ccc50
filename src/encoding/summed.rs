//! Summed-area tables of moments: the Rust twins of `shaders/summed.wgsl` and `half_widths.wgsl`.
//!
//! With P(x, y) the sum of all texels of a view before x in u and before y in v, the sum over a box is
//!
//! ```text
//! (1)  P(x₁, y₁) − P(x₀, y₁) − P(x₁, y₀) + P(x₀, y₀)
//! ```
//!
//! whatever its width is. Sums are of 16-bit integers, in 32 bits that wrap around: (1) is exact where the box's own
//! sum fits, which is up to 65537 texels, however much the whole map sums to. Sums of f32 lose a bit with every
//! doubling of the map instead, and variance its shadows with them.
//!
//! A box begins and ends within texels. Nine boxes of whole texels make it up, weighted by what of them it covers: the
//! mean is continuous in place and width, and one texel wide it is what a sampler interpolates.
//!
//! The half-width is the one of [`blur`](super::blur), at the receiver instead of at a texel. With a and b the
//! gradients of u and v across the light,
//!
//! ```text
//! (2)  1/|t_u| = side |a × b| / |b|,   1/|t_v| = side |a × b| / |a|
//! ```
//!
//! # References
//! - Crow, *Summed-area tables for texture mapping*, 1984.
//! - Lauritzen, *Summed-area variance shadow maps*, GPU Gems 3, 2007 (integers, and box widths per receiver).
//! - Hensley, Scheuermann, Coombe, Singh & Lastra, *Fast summed-area table generation and its applications*, 2005.
//! - `MATH.md` section 7 (what sums of f32 lose).

use glam::{IVec2, UVec4, Vec2, Vec3, Vec4, Vec4Swizzles};

use super::depth::CompareMap;
use crate::frame::ViewUniforms;

/// Twin of the shader's constant: most texels of a half-width. Boxes of 256 by 256 texels of 16 bits are what 32 bits
/// hold, ends within texels included.
pub const ANTUMBRA_BOX_MOST: f32 = 127.0;

/// Twin of the shader's constant: steps of a number from 0 to 1.
pub const ANTUMBRA_BOX_STEPS: f32 = 65535.0;

/// Twin of the shader's constant: below every w in view.
const ANTUMBRA_BOX_SMALLEST_W: f32 = 1e-6;

/// Twin of the shader's constant: below every length that is divided by.
const ANTUMBRA_BOX_SMALLEST: f32 = 1e-30;

/// Twin of `antumbra_counted`: numbers from 0 to 1 as integers.
#[must_use]
pub fn antumbra_counted(stored: Vec4) -> UVec4 {
    (stored.clamp(Vec4::ZERO, Vec4::ONE) * ANTUMBRA_BOX_STEPS + 0.5).floor().as_uvec4()
}

/// Twin of `antumbra_half_widths`: half-widths in texels of u and v of the box that a receiver reads.
#[must_use]
pub fn antumbra_half_widths(view: &ViewUniforms, position: Vec3, uv: Vec2) -> Vec2 {
    let [u_row, v_row, w_row] = [view.u_from_render, view.v_from_render, view.w_from_render].map(Vec4::from_array);
    let [.., radius] = view.moments;
    let w = w_row.dot(position.extend(1.0)).max(ANTUMBRA_BOX_SMALLEST_W);
    let along_u = (u_row.xyz() - uv.x * w_row.xyz()) / w;
    let along_v = (v_row.xyz() - uv.y * w_row.xyz()) / w;
    let lengths = Vec2::new(along_v.length(), along_u.length()).max(Vec2::splat(ANTUMBRA_BOX_SMALLEST));
    let world = radius * along_u.cross(along_v).length() / (lengths * view.bias[3].max(ANTUMBRA_BOX_SMALLEST));
    let texels = if radius >= 0.0 { world } else { Vec2::splat(-radius) };
    texels.min(Vec2::splat(ANTUMBRA_BOX_MOST))
}

/// Twin of `AntumbraEdges`: which texels a box begins and ends in, along one axis, and what it covers of the first, of
/// those in between, and of the last.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edges {
    nodes: [i32; 4],
    weights: Vec3,
    whole: f32,
}

/// Twin of `antumbra_edges`: of a box in a tile of `side` texels; towards the rim, beyond which nothing is drawn, it
/// narrows.
fn antumbra_edges(place: f32, radius: f32, side: f32) -> Edges {
    let at = place.max(0.5).min(side - 0.5);
    let room = at.min(side - at) - 1.5;
    let half = radius.min(room).max(0.5);
    let low = at - half;
    let high = at + half;
    let first = low.floor();
    let last = high.floor().max(first + 1.0);
    let weights = Vec3::new(first + 1.0 - low, 1.0, (high - last).max(0.0));
    Edges {
        nodes: [first, first + 1.0, last, (last + 1.0).min(side)].map(|node| node as i32),
        weights,
        whole: weights.x + (last - first - 1.0) + weights.z,
    }
}

/// Twin of `antumbra_summed`: the mean of what is stored around a place in a view's map, over a box of these
/// half-widths in texels. `map` is the layer or the view's map in it.
#[must_use]
pub fn antumbra_summed(map: &impl CompareMap, view: &ViewUniforms, uv: Vec2, radius: Vec2) -> Vec4 {
    let [left, top, right, bottom] = view.rect;
    let (half, size) = (0.5 * view.bias[3], map.size().as_vec2());
    let (low, high) = (Vec2::new(left, top) - half, Vec2::new(right, bottom) + half);
    let corner = (low * size).floor();
    let side = (high * size).floor() - corner + 1.0;
    let place = uv * size - corner;
    let (u, v) = (antumbra_edges(place.x, radius.x, side.x), antumbra_edges(place.y, radius.y, side.y));
    let rows = v.nodes.map(|y| antumbra_sums_of_row(map, corner.as_ivec2(), u.nodes, y));
    let strip = |index: usize| {
        let [above, below] = [rows[index], rows[index + 1]];
        let cell = |column: usize| (below[column].wrapping_sub(above[column])).as_vec4();
        cell(0) * u.weights.x + cell(1) * u.weights.y + cell(2) * u.weights.z
    };
    let sum = strip(0) * v.weights.x + strip(1) * v.weights.y + strip(2) * v.weights.z;
    sum / (u.whole * v.whole * ANTUMBRA_BOX_STEPS)
}

/// Twin of `antumbra_sums_of_row`: sums of all rows before `y`, between the columns.
fn antumbra_sums_of_row(map: &impl CompareMap, corner: IVec2, columns: [i32; 4], y: i32) -> [UVec4; 3] {
    let [a, b, c, d] = columns.map(|x| antumbra_sum_before(map, corner, IVec2::new(x, y)));
    [b.wrapping_sub(a), c.wrapping_sub(b), d.wrapping_sub(c)]
}

/// Twin of `antumbra_sum_before`: the sum of all texels of the tile before a place.
fn antumbra_sum_before(map: &impl CompareMap, corner: IVec2, node: IVec2) -> UVec4 {
    if node.min_element() > 0 { map.sum(corner.wrapping_add(node).wrapping_sub(IVec2::ONE)) } else { UVec4::ZERO }
}
