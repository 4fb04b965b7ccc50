//! What a fit gives back: views to draw, uniforms to upload, and an account of what was left out.

use arrayvec::ArrayVec;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, DVec4, Mat4, UVec4, Vec4};

use crate::content::{Content, Place};
pub use crate::key::{MapShape, Pcf, Select, WgslKey};
use crate::report::{LeftOut, Part, Why};
use crate::scene::{Aabb, MapBudget};
use crate::texel::BlurUniforms;

/// Most views of one light.
pub const MAX_VIEWS: usize = 8;

/// Most planes of depth splits: the ends of the range, and one between any two maps.
pub const MAX_PLANES: usize = MAX_VIEWS + 1;

/// Most lines of [`ShadowFrame::left_out`]: nine a view (receivers, window, border, texels, penumbra or levels, blur,
/// bleeding, and two of the warp), and seven of the whole.
pub const MAX_LEFT_OUT: usize = 9 * MAX_VIEWS + 7;

/// Most planes of a [`CullVolume`].
pub const MAX_CULL_PLANES: usize = 8;

/// Everything one light needs for one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowFrame {
    /// The maps to draw, in order. None: nothing to shadow, and `left_out` says why.
    pub views: ArrayVec<ShadowView, MAX_VIEWS>,
    /// What the receiver shader reads: upload verbatim.
    pub uniforms: ShadowUniforms,
    /// The shader text these uniforms are for.
    pub wgsl: WgslKey,
    /// The texels it was fitted for.
    pub map: MapBudget,
    /// What was left out, clamped or replaced, and why.
    pub left_out: ArrayVec<LeftOut, MAX_LEFT_OUT>,
    /// The predicted sampling error over all views.
    pub predicted: Footprint,
    /// Eye depths of the planes that were searched for, ends included, world units, ascending: the next frame may keep
    /// them. None where nothing was searched.
    pub(crate) planes: ArrayVec<f64, { MAX_VIEWS + 1 }>,
}

impl ShadowFrame {
    /// A frame in which nothing is shadowed yet: everything reads lit. Techniques from outside of this crate add views
    /// ([`ShadowView::new`]) and fill in their uniforms.
    #[must_use]
    pub fn lit(wgsl: WgslKey, map: MapBudget) -> Self {
        Self {
            views: ArrayVec::new(),
            uniforms: ShadowUniforms { views: [ViewUniforms::LIT; MAX_VIEWS], counts: [0; 4] },
            wgsl,
            map,
            left_out: ArrayVec::new(),
            predicted: Footprint::NONE,
            planes: ArrayVec::new(),
        }
    }

    /// Takes back all views, and what was left out after the first `said` lines.
    pub(crate) fn take_back(&mut self, said: usize) {
        self.views.clear();
        self.uniforms = ShadowUniforms { views: [ViewUniforms::LIT; MAX_VIEWS], counts: [0; 4] };
        self.left_out.truncate(said);
    }

    /// Notes what was left out. The capacity follows from the most reasons a plan can have.
    pub(crate) fn leave_out(&mut self, part: Part, why: Why) {
        let _ = self.left_out.try_push(LeftOut { part, why });
    }
}

/// One map to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowView {
    /// Render space (world − `origin`) to the map's clip space; z is linear in depth for directional light, and is not
    /// divided by w where the map is warped: fragments of casters write it ([`MapShape`]).
    pub clip_from_render: Mat4,
    /// Linear light depth in [0, 1] of a render-space position: `dot(depth_from_render, (x, y, z, 1))`.
    pub depth_from_render: Vec4,
    /// Where to draw: x, y, width, height, texels of the layer. One texel around it belongs to the map as well, and
    /// stays cleared to the farthest depth. Several views may have their tiles in one layer
    /// ([`Share`](crate::Share)): clear no more of it than that.
    pub viewport: UVec4,
    /// Array layer of the map.
    pub layer: u32,
    /// What may throw a shadow into this view.
    pub cull: CullVolume,
    /// Size of its texels.
    pub texel: TexelSize,
    /// κ·λ of the warp that was applied; 0 is uniform (MATH.md section 0).
    pub warp_strength: f32,
    /// Eye depths of the receivers it serves, world units: nearest, farthest.
    pub domain: [f32; 2],
    /// What has to be drawn of it if casters have not moved since `FitInput::previous`. Snapped maps of still scenes
    /// scroll, or stay.
    pub content: Content,
    /// What the passes that filter its texels have to know, for maps of moments.
    pub blur: BlurUniforms,
    /// Where its texels are in the world.
    pub(crate) place: Place,
    /// Number of the split that it was made for.
    pub(crate) split: u8,
}

impl ShadowView {
    /// A view as techniques from outside of this crate make it; all other fields say nothing, and may be filled in.
    /// `clip_from_render` and `depth_from_render` are as documented there.
    #[must_use]
    pub fn new(clip_from_render: Mat4, depth_from_render: Vec4, viewport: UVec4, layer: u32, cull: CullVolume) -> Self {
        Self {
            clip_from_render,
            depth_from_render,
            viewport,
            layer,
            cull,
            texel: TexelSize { world: [0.0; 2], pixels: Footprint::NONE },
            warp_strength: 0.0,
            domain: [0.0, f32::MAX],
            content: Content::Redraw,
            blur: BlurUniforms::default(),
            place: Place::UNKNOWN,
            split: 0,
        }
    }
}

/// Size of a view's texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelSize {
    /// Smallest and largest side of a texel across the light, world units.
    pub world: [f32; 2],
    /// Smallest and largest extent of a texel in the picture, pixels.
    pub pixels: Footprint,
}

/// Extent of a shadow-map texel in the picture, pixels per texel (Lloyd's m; 1 or less means no aliasing).
///
/// Kind of promise: exact at the vertices of the focus body for receivers perpendicular to the light and seen head-on
/// (perspective aliasing); surfaces at a slant to the light (projection aliasing) can be larger by 1/cos.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Smallest, pixels.
    pub min: f32,
    /// Largest, pixels.
    pub max: f32,
    /// Predicted picture error: the mean side of a texel over what is seen, world units. It ranks maps of one
    /// picture; strong warps come out better than it says. Kind of promise: typical (`docs/WARPS.md`).
    pub error: f32,
}

impl Footprint {
    /// No texel at all.
    pub const NONE: Self = Self { min: 0.0, max: 0.0, error: 0.0 };
}

/// The casters of a view: a convex volume that is open towards the light.
#[derive(Clone, Debug, PartialEq)]
pub struct CullVolume {
    /// World position of render space's origin.
    pub(crate) origin: DVec3,
    /// Half-spaces `dot(normal, x) + offset >= 0` in render space.
    pub(crate) planes: ArrayVec<DVec4, MAX_CULL_PLANES>,
}

impl CullVolume {
    /// The half-spaces `dot(plane, (x, y, z, 1)) >= 0` of render space around `origin`, of which at most
    /// [`MAX_CULL_PLANES`] are kept: fewer keep more casters.
    #[must_use]
    pub fn new(origin: DVec3, planes: &[DVec4]) -> Self {
        Self { origin, planes: planes.iter().copied().take(MAX_CULL_PLANES).collect() }
    }

    /// False only if nothing within `bounds` (world space) can throw a shadow that the view shows.
    ///
    /// Conservative: exact for each plane of the volume alone. O(planes).
    #[must_use]
    pub fn may_cast(&self, bounds: &Aabb) -> bool {
        if bounds.is_empty() {
            return false;
        }
        let centre = bounds.centre() - self.origin;
        let half = bounds.half_size();
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            // The farthest corner along the normal; a NaN (overflowing box) keeps the caster.
            !(normal.dot(centre) + plane.w + normal.abs().dot(half) < 0.0)
        })
    }

    /// The half-spaces in render space: `dot(plane, (x, y, z, 1)) >= 0` inside.
    #[must_use]
    pub fn planes(&self) -> &[DVec4] {
        &self.planes
    }
}

/// The receiver shader's uniform block. A key reads as many elements as it has maps (208 bytes each).
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ShadowUniforms {
    /// One block per view; views that are not in use read lit.
    pub views: [ViewUniforms; MAX_VIEWS],
    /// Number of views in use; the rest is padding.
    pub counts: [u32; 4],
}

/// What the receiver shader knows of one view. The layout equals `AntumbraView` in the shader, member by member.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ViewUniforms {
    /// Texture coordinate u (times w) of a render-space position: a row.
    pub u_from_render: [f32; 4],
    /// Texture coordinate v (times w): a row.
    pub v_from_render: [f32; 4],
    /// The divisor w: a row; (0, 0, 0, 1) when the map is affine.
    pub w_from_render: [f32; 4],
    /// Linear light depth in [0, 1], less the constant bias: a row.
    pub depth_from_render: [f32; 4],
    /// x, y: how far a plane falls over one texel step in u and in v, along its normal and in world units, for each
    /// unit of `dot(row, normal)` of those rows; 0 with a manual bias that is not slope-scaled. z: square of the depth
    /// per world unit along the light. w: size of `dot(depth_from_render, normal)` below which a surface grazes the
    /// light.
    pub texel: [f32; 4],
    /// x: texels that are added to the reach of a filter: what rounding loses, or what makes it a slope-scaled bias.
    /// y: manual normal offset, world units. z: warped maps: by how much of itself a texel outgrows its neighbours in u
    /// and in v together, for each unit of w; 0 without automatic bias. w: side of a texel, texture coordinates.
    pub bias: [f32; 4],
    /// The part of the layer that is drawn, in texture coordinates: u min, v min, u max, v max. The texels around it
    /// stay cleared, so that lookups beyond the window, which read those, read lit.
    pub rect: [f32; 4],
    /// Warped maps: how far a plane of normal n falls over a texel step at (u, v), along its normal and in world units,
    /// is w² (n·V − v n·W) for a step in u and w² (u n·W − n·U) for a step in v, with U this row, V `across_v` and W
    /// `across_w` (x, y, z of each). All 0 with a manual bias that is not slope-scaled. w: array layer of the map.
    pub across_u: [f32; 4],
    /// Warped maps: V of `across_u`. w, of the first view of several that are found by containment: eye depth at which
    /// shadows begin to give way to light.
    pub across_v: [f32; 4],
    /// Warped maps: W of `across_u`. w, of the first view: one over the length of that band, 0 for none.
    pub across_w: [f32; 4],
    /// Several maps: nearest and farthest eye depth that the view serves (found by depth, the last one serves
    /// everything behind it). Found by depth: the depth at which it begins to give way to the next one, and one over
    /// the length of that band (0: no band). Found by containment: what a filter reads beyond a receiver, and one over
    /// the width of the band along the rim in which it gives way, texture coordinates.
    pub domain: [f32; 4],
    /// Maps of moments with mips: texels of the map over a pixel at a render-space position, where w is 1: a row.
    /// Filters of the pixel: size of a pixel there across the line of sight, world units.
    pub pixel_from_render: [f32; 4],
    /// Maps of moments: x: light up to this share is taken for bleeding. y: last level of the mip chain. z: how far
    /// receivers are lifted for a texel of their level, beyond one of the map, as a share of it, 0 without automatic
    /// bias. w: half-width of the
    /// blur, world units where it is not negative, else texels, negated; only sums
    /// ([`Summed`](crate::MomentFormat::Summed)) are read as wide. Maps of depths with penumbras ([`Pcf::Pcss`]): x:
    /// radius of the penumbra, world units, for each unit of linear light depth between caster and receiver. y: radius
    /// of the widest penumbra, texels. z, w: 0. Filters of the pixel ([`Pcf::Pixel`]): x, y, z: the eye, render space,
    /// w: 1; or for parallel views the direction of sight, negated, and 0.
    pub moments: [f32; 4],
}

impl ViewUniforms {
    /// A view that reads lit everywhere: every receiver is in front of every caster.
    pub const LIT: Self = Self {
        u_from_render: [0.0; 4],
        v_from_render: [0.0; 4],
        w_from_render: [0.0, 0.0, 0.0, 1.0],
        depth_from_render: [0.0, 0.0, 0.0, -1.0],
        texel: [0.0, 0.0, 0.0, 1.0],
        bias: [0.0; 4],
        rect: [0.0; 4],
        across_u: [0.0; 4],
        across_v: [0.0; 4],
        across_w: [0.0; 4],
        domain: [0.0, f32::MAX, 0.0, 0.0],
        pixel_from_render: [0.0; 4],
        moments: [0.0; 4],
    };
}
