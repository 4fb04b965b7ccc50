//! Bias from the size of a texel, and from nothing else.
//!
//! A texel stores the depth of its centre; a filter reads texels up to its *reach* away. Over that distance the plane
//! of the receiver falls towards the light by `reach · s · (|n_p| + |n_q|)` measured along its normal, where s is the
//! size of a texel and n the normal in light space. The receiver is lifted by exactly that: along the light as long as
//! that is short (which moves no shadow edge), along the normal where the surface grazes the light and the distance
//! along the light would grow as the tangent.
//!
//! # Warped maps
//! A texel's size differs from texel to texel there, and moving along the normal moves through texels of any size. So
//! receivers of warped maps move *across* the light, by a number of texels, instead of along their normal:
//!
//! ```text
//! (1)  x(Δ) − x = J⁻¹Δ / (1 − g·Δ)       the texel Δ texels away; exact: warps map lines to lines
//! (2)  h(Δ) = fall·Δ / (1 − g·Δ)         how far above its plane a point is that the receiver moves to; fall = n·J⁻¹
//! (3)  δ = (1 − c) R fall (|fall_u| + |fall_v|) / fall·fall,   so that fall·δ = (1 − c) R (|fall_u| + |fall_v|)
//! (4)  lift ≥ (tap + R G) / (1 − G)      steps of the fall along the light, G ≥ |g·Δ|
//! ```
//!
//! J is the derivative of texels by place across the light at the receiver, g how much a texel outgrows its neighbours
//! there, R the reach, c the share of the lift that is along the light: 1 down to a cosine of [`GRAZING_COSINE`], then
//! falling to 0 with the cosine. A tap at o texels from δ, which reads texels δ + Δ with |Δ| ≤ R and |Δ − o| ≤ tap, is
//! lit if h(δ + Δ) + c lift − c fall·o ≥ 0 for all of them. Times 1 − g·(δ + Δ) > 0 that is the sum of a part with 1 −
//! c, R (|`fall_u`| + |`fall_v`|) + fall·Δ ≥ 0, in which no growth appears, and a part with c, which (4) satisfies. (3)
//! is at most (1 + √2)/2 of the reach along either axis, whatever the shape of texels, so that it stays within the
//! map's border. In a map of square, equal texels it is the way along the normal, over the squared sine of incidence.
//!
//! # References
//! - `MATH.md` section 7, *Bias*: b = (r + ½) s (|`n_x`| + |`n_y`|) / |`n_z`|, exact; δ = (r + ½) s (|`n_x`| +
//!   |`n_y`|), bounded.

use glam::{DVec2, DVec3, DVec4, Vec4};

use crate::content::Tile;
use crate::error::{FitError, within};
use crate::frame::ViewUniforms;
use crate::math::space::{Clip, Map, Render};
use crate::warp::window::Window;

/// How a receiver is kept from shadowing itself.
///
/// Casters' pipelines may cull front faces as well (`cull_mode: Some(Face::Front)`; they run counter-clockwise in a
/// map as in the camera's picture) where all casters are closed. `docs/BIAS.md` measures all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Bias {
    /// From the texel size, the reach of the filter and the precision of positions. Bounded; needs no tuning.
    #[default]
    Automatic,
    /// By hand, for engines that have tuned theirs: the sum of three. The automatic bias is off, that of wide blurs and
    /// of mip levels as well; only the rounding of depths is still accounted for. All of them 0 is no bias, but for the
    /// taps of [`Pcf::Pixel`](crate::Pcf), which are always lifted by their distance.
    Manual {
        /// Constant: distance along the light, world units, 0 to 1e9.
        depth_world: f32,
        /// Slope-scaled: along the light, by what the receiver's plane falls over a step of this many texels along both
        /// axes of the map, 0 to 1e9. That is the polygon offset of rasterisers but for the sum of both slopes in place
        /// of the larger one, and for linear depth in warped maps as well. It grows as the tangent of incidence and is
        /// held at a cosine of 0.01. A point reads up to 0.5 texels away, hardware 2×2 up to 1.
        slope_texels: f32,
        /// Distance along the surface normal, in texels (their longer side), 0 to 1e9.
        normal_texels: f32,
    },
}

/// Cosine of incidence below which a receiver is lifted along its normal instead of along the light. At 0.3 (72.5°) the
/// lift along the light is at most 4.7 texels. Towards 0 it grows as the tangent and shadows of near objects detach;
/// towards 1 every lift is along the normal and shadow edges shift by up to a texel on slanted ground.
const GRAZING_COSINE: f32 = 0.3;

/// Cosine of incidence below which a slope-scaled bias grows no more (89.4°): the clamp of engines. At 0.1 steep walls
/// keep their acne; at 0 the bias is infinite where light passes along a surface.
const STEEPEST_COSINE: f32 = 0.01;

/// Rasterisers snap vertices to 1/256 of a texel, which moves a plane by as much; both ends of an edge may move.
const RASTER_SNAP: f64 = 2.0 / 256.0;

/// Rounding steps between a position and a compared depth: the product with a matrix row (4), interpolation across the
/// triangle in both passes (2), storing (1), rounded up to a power of two. Fewer shows as acne far from the origin;
/// more lets light through at contacts, by that many steps of f32.
const DEPTH_ROUNDINGS: f64 = 8.0;

/// Largest manual bias, world units or texels: far beyond use, far below overflow.
const LARGEST_MANUAL: f64 = 1e9;

/// What a view's bias depends on.
pub(crate) struct BiasInput<'a> {
    /// The part of the plane across the light that is drawn.
    pub(crate) window: &'a Window,
    /// Size of a texel in (p, q), world units where W = 1.
    pub(crate) texel: DVec2,
    /// Depth range of the map along the light, world units.
    pub(crate) depth_range: f64,
    /// Clip space of the map.
    pub(crate) clip_from_render: &'a Map<Clip, Render>,
    /// Rows of u, v (times w) and w.
    pub(crate) texture_from_render: &'a [DVec4; 3],
    /// Largest coordinates of receivers, render space, each not negative.
    pub(crate) reach: DVec3,
    /// Its texels in the layers.
    pub(crate) tile: Tile,
    /// How far one sample of the filter reads, texels.
    pub(crate) tap_reach: f64,
}

/// What the shader's arithmetic is given for a bias.
struct Knobs {
    /// Whether the receiver's plane is known to it: 1, or 0.
    plane: f64,
    /// What is added to every reach, texels.
    reach: f64,
    /// Cosine below which receivers are lifted along their normal.
    grazing: f32,
    /// Whether the lift grows with the texels of a warped map: 1, or 0.
    growing: f64,
    /// Distance along the light, depths of the map.
    constant: f64,
    /// Distance along the normal, world units.
    offset: f64,
}

impl Bias {
    /// Writes the bias of a view into its uniforms, whose rows are there already.
    pub(crate) fn write(self, input: &BiasInput, uniforms: &mut ViewUniforms) {
        // What rounding adds: to the texel that is looked up, and to the depth that is compared.
        let half_ulp = 0.5 * f64::from(f32::EPSILON);
        let rounding = |row: DVec4| half_ulp * (row.truncate().abs().dot(input.reach) + row.w.abs());
        // What w loses moves a texel by as much of its distance from the middle of the map; w is 1 or more.
        let warped = if input.window.bend.is_none() { 0.0 } else { rounding(input.clip_from_render.row(3)) };
        let [side, of] = [input.tile.side, input.tile.of].map(f64::from);
        let lost = rounding(input.clip_from_render.row(0)).max(rounding(input.clip_from_render.row(1))) + warped;
        // Tiles lie elsewhere in their layer than where clip space begins.
        let lost_texels = side * lost + (of - side) * half_ulp;
        let lost_depth = DEPTH_ROUNDINGS * (rounding(input.clip_from_render.row(2)) + half_ulp);
        // What is added to a reach is lost whatever the filter is.
        let knobs = self.knobs(input, RASTER_SNAP + lost_texels);
        // How far a plane falls over a texel for each unit of a row along its normal.
        let texel = input.texel * knobs.plane;
        let per_row = |row: [f32; 4]| 1.0 / Vec4::from_array(row).truncate().as_dvec3().length();
        let depth_per_unit = 1.0 / input.depth_range;
        uniforms.texel = [
            texel.x * per_row(uniforms.u_from_render),
            texel.y * per_row(uniforms.v_from_render),
            depth_per_unit * depth_per_unit,
            f64::from(knobs.grazing) * depth_per_unit,
        ]
        .map(narrowed);
        let (across, growth) = input.across();
        let [mut across_u, across_v, across_w] =
            across.map(|row| (row * knobs.plane).extend(0.0).to_array().map(narrowed));
        across_u[3] = input.tile.layer as f32;
        (uniforms.across_u, uniforms.across_v, uniforms.across_w) = (across_u, across_v, across_w);
        uniforms.bias = [knobs.reach, knobs.offset, growth * knobs.growing, 1.0 / of].map(narrowed);
        // A constant bias is the same as a depth row that starts earlier, and costs nothing there.
        let depth = input.clip_from_render.row(2);
        uniforms.depth_from_render = [depth.x, depth.y, depth.z, depth.w - lost_depth - knobs.constant].map(narrowed);
    }
}

impl Bias {
    /// What the shader is given; `lost` texels of reach go to rounding.
    fn knobs(self, input: &BiasInput, lost: f64) -> Knobs {
        match self {
            Self::Automatic => {
                Knobs { plane: 1.0, reach: lost, grazing: GRAZING_COSINE, growing: 1.0, constant: 0.0, offset: 0.0 }
            }
            // The shader adds the reach of its filter to that of the uniforms: what is left is the slope's.
            Self::Manual { depth_world, slope_texels, normal_texels } => Knobs {
                plane: if slope_texels > 0.0 { 1.0 } else { 0.0 },
                reach: f64::from(slope_texels) - input.tap_reach,
                grazing: STEEPEST_COSINE,
                growing: 0.0,
                constant: f64::from(depth_world) / input.depth_range,
                offset: f64::from(normal_texels) * input.texel.max_element(),
            },
        }
    }
}

impl BiasInput<'_> {
    /// For warped maps: the vectors of which the shader makes the fall of a plane over a texel step, and by how much of
    /// itself a texel outgrows its neighbours in u and in v together, for each unit of W.
    ///
    /// With (u, v) = (U, V)/W and J = ∂(u, v)/∂(p, q), the world step of a texel in u is the first column of J⁻¹ over
    /// the layer's side, that in v the second one:
    ///
    /// ```text
    /// t_u = −W² (∇V × t − v ∇W × t) / (D · side),   t_v = W² (∇U × t − u ∇W × t) / (D · side)
    /// ```
    ///
    /// where D = W³ det J is constant and t is the travel of light. The change of W along them is W² ∇W · (…), to which
    /// the second term adds nothing.
    pub(crate) fn across(&self) -> ([DVec3; 3], f64) {
        let [u, v, w] = *self.texture_from_render;
        let (light, bend) = (&self.window.light, &self.window.bend);
        // D at the anchor, where W is 1.
        let anchor = (light.p() * bend.anchor.x + light.q() * bend.anchor.y).extend(1.0);
        let at_anchor = |row: DVec4| row.truncate() - w.truncate() * row.dot(anchor);
        let determinant = -light.travel().dot(at_anchor(u).cross(at_anchor(v)));
        let scale = -1.0 / (determinant * f64::from(self.tile.of));
        let across = [u, v, w].map(|row| row.truncate().cross(light.travel()) * scale);
        let growth = w.truncate().dot(across[0]).abs() + w.truncate().dot(across[1]).abs();
        (across, growth)
    }
}

impl Bias {
    /// Checks manual values.
    pub(crate) fn validate(self) -> Result<(), FitError> {
        let Self::Manual { depth_world, slope_texels, normal_texels } = self else { return Ok(()) };
        for (field, value) in [
            ("bias.depth_world", depth_world),
            ("bias.slope_texels", slope_texels),
            ("bias.normal_texels", normal_texels),
        ] {
            within(field, value, [0.0, LARGEST_MANUAL], "0 to 1e9")?;
        }
        Ok(())
    }
}

/// To f32, which holds no infinity here.
fn narrowed(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}
