//! From a key to shader text: the fragments it needs and no others.
//!
//! The fragments are plain WGSL without bindings, entry points, overrides or directives, and every item carries the
//! prefix `antumbra_`, `Antumbra` or `ANTUMBRA_`. [`library`] is their concatenation order; [`module`] adds the
//! bindings, with numbers chosen by the caller, and the function an engine calls:
//!
//! ```wgsl
//! fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32
//! ```
//!
//! `position` is in render space (world − `origin`), `normal` is the unit geometric normal on the side that is looked
//! at, `view_depth` the eye depth (read by techniques with several maps that are told apart by depth). The value is the
//! share of light that arrives.
//!
//! Filters whose taps lie on a disc ([`Pcf::Disc`], [`Pcf::Pcss`]) have as well
//!
//! ```wgsl
//! fn antumbra_visibility_noisy(position: vec3f, normal: vec3f, view_depth: f32, noise: f32) -> f32
//! ```
//!
//! which turns the disc by `noise` of a whole turn, 0 to 1 (interleaved gradient noise of the pixel, say), so that
//! bands become grain; `antumbra_visibility` is that with a noise of 0.
//!
//! The same in two stages, for one affine map (uniform ones; see [`MapShape`]), filters of texels, no rule for grazing
//! light ([`Grazing`]), and engines that want the cheapest fragments:
//!
//! ```wgsl
//! fn antumbra_place(position: vec3f, normal: vec3f) -> AntumbraLookup   // in the vertex stage
//! fn antumbra_lit(look: AntumbraLookup) -> f32                          // in the fragment stage
//! ```
//!
//! `AntumbraLookup` has the members `uv: vec2f`, `depth: f32` and `slope: vec2f`, in this order; carry `uv` and `depth`
//! from stage to stage with perspective-correct interpolation, and `slope` only for [`Pcf::Box3x3`], [`Pcf::Box5x5`]
//! and [`Pcf::Box7x7`] (the other filters never read it: pass `vec2f()`). Then fragments load no uniforms and receive
//! no normal.
//!
//! Kind of promise: exact, up to rounding, where all vertices of a triangle are given one normal, because all members
//! are then linear in position (`slope` is constant). With smooth normals the bias is interpolated: near enough on
//! triangles that are small beside the curvature, too little across large ones, where acne may show; those take
//! `antumbra_visibility`. Choose the side that is looked at from the eye position; all vertices of a face then agree.

mod disc;
mod grazing;
mod moments;

use core::fmt::Write as _;
use std::borrow::Cow;

use arrayvec::ArrayVec;

use crate::frame::{MAX_VIEWS, MapShape, Pcf, Select, WgslKey};
use crate::grazing::Grazing;
use crate::texel::{Moments, Texel};

/// Where the generated bindings go: `group`, and three binding numbers from `first` on (uniforms, map, sampler).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bindings {
    /// Bind group index.
    pub group: u32,
    /// First of [`BINDING_COUNT`] consecutive binding numbers.
    pub first: u32,
}

/// Number of bindings: the uniforms, the map, its sampler (one that compares, for maps of depths).
pub const BINDING_COUNT: u32 = 3;

/// Most fragments of a key.
const MAX_FRAGMENTS: usize = 21;

/// The fragments of a key, in order; concatenated they are one valid module without bindings or entry points.
///
/// The texts live in the binary: no allocation for one map of depths and filters without a disc. For others, the texts
/// that name the texture and its sampler, or hand noise on, are made anew.
#[must_use]
pub fn library(key: WgslKey) -> ArrayVec<Cow<'static, str>, MAX_FRAGMENTS> {
    let is_plain = texture(key) == "texture_depth_2d";
    let named = |text: Cow<'static, str>| if is_plain { text } else { with_types(&text, key).into() };
    fragments(key).into_iter().map(named).collect()
}

/// The type of the map, as functions take it.
#[must_use]
pub fn texture(key: WgslKey) -> &'static str {
    match (key.texel, is_arrayed(key)) {
        (Texel::Depth, false) => "texture_depth_2d",
        (Texel::Depth, true) => "texture_depth_2d_array",
        (Texel::Moments(moments), false) if moments.is_summed() => "texture_2d<u32>",
        (Texel::Moments(moments), true) if moments.is_summed() => "texture_2d_array<u32>",
        (Texel::Moments(_), false) => "texture_2d<f32>",
        (Texel::Moments(_), true) => "texture_2d_array<f32>",
    }
}

/// Whether the map is an array of layers: several maps, or one with more numbers than a texel holds.
pub(crate) fn is_arrayed(key: WgslKey) -> bool {
    key.maps > 1 || matches!(key.texel, Texel::Moments(moments) if moments.layers() > 1)
}

/// The type of its sampler, as functions take it.
#[must_use]
pub const fn sampler(key: WgslKey) -> &'static str {
    match key.texel {
        Texel::Depth => "sampler_comparison",
        Texel::Moments(_) => "sampler",
    }
}

/// A text with the types of a key, whichever it was written with.
fn with_types(text: &str, key: WgslKey) -> String {
    const TEXTURES: [&str; 6] = [
        "texture_depth_2d_array,",
        "texture_depth_2d,",
        "texture_2d_array<f32>,",
        "texture_2d<f32>,",
        "texture_2d_array<u32>,",
        "texture_2d<u32>,",
    ];
    let typed = format!("{},", texture(key));
    let text = TEXTURES.iter().fold(text.to_owned(), |text, other| text.replace(other, &typed));
    text.replace("sampler_comparison", sampler(key))
}

fn fragments(key: WgslKey) -> ArrayVec<Cow<'static, str>, MAX_FRAGMENTS> {
    let mut fragments = ArrayVec::new();
    let mut push = |text: &'static str| fragments.push(Cow::Borrowed(text));
    // What is known of a map, and the maps.
    push(include_str!("../shaders/view.wgsl"));
    if key.maps > 1 {
        push(MAPS[usize::from(key.maps.min(MAX_VIEWS as u8)) - 2]);
        push(include_str!("../shaders/uniforms_many.wgsl"));
    } else {
        push(include_str!("../shaders/uniforms_one.wgsl"));
    }
    let map = match (key.texel, is_arrayed(key)) {
        (Texel::Depth, false) => include_str!("../shaders/map_one.wgsl"),
        (Texel::Depth, true) => include_str!("../shaders/map_many.wgsl"),
        (Texel::Moments(moments), arrayed) => moments::map(moments, arrayed),
    };
    fragments.extend(disc::map(key, map));
    let mut push = |text: &'static str| fragments.push(Cow::Borrowed(text));
    push(CASTER);
    // Where a receiver is looked up.
    match key.shape {
        MapShape::Affine => push(include_str!("../shaders/lookup.wgsl")),
        MapShape::Projective => push(include_str!("../shaders/law_linear.wgsl")),
        MapShape::ProjectiveDepth => push(include_str!("../shaders/law_projective.wgsl")),
    }
    if key.shape != MapShape::Affine {
        push(include_str!("../shaders/lookup_projective.wgsl"));
    }
    // What is read there.
    match key.texel {
        Texel::Depth => pcf(key).into_iter().for_each(&mut push),
        Texel::Moments(moments) => fragments.extend(moments::read(moments, is_arrayed(key))),
    }
    fragments.extend(look(key).into_iter().map(Cow::Borrowed));
    let visible = if is_arrayed(key) {
        include_str!("../shaders/visibility_many.wgsl")
    } else {
        include_str!("../shaders/visibility_one.wgsl")
    };
    fragments.extend(disc::noisy(key, visible, disc::VISIBLE_STEADY));
    fragments.extend(grazing::rule(key.grazing));
    fragments
}

/// How depths are compared.
fn pcf(key: WgslKey) -> ArrayVec<&'static str, 5> {
    const TAP: &str = include_str!("../shaders/pcf_tap.wgsl");
    let mut fragments: ArrayVec<_, 5> = match key.filter {
        Pcf::Point => core::iter::once(include_str!("../shaders/pcf_point.wgsl")).collect(),
        Pcf::Hardware2x2 => core::iter::once(include_str!("../shaders/pcf_hardware.wgsl")).collect(),
        Pcf::Pixel => [include_str!("../shaders/over_pixel.wgsl"), include_str!("../shaders/pcf_pixel.wgsl")]
            .into_iter()
            .collect(),
        Pcf::Box3x3 => [TAP, include_str!("../shaders/pcf_box_three.wgsl")].into_iter().collect(),
        Pcf::Box5x5 => [TAP, include_str!("../shaders/pcf_box_five.wgsl")].into_iter().collect(),
        Pcf::Box7x7 => [TAP, include_str!("../shaders/pcf_box_seven.wgsl")].into_iter().collect(),
        Pcf::Disc => [TAP, disc::POINTS, include_str!("../shaders/pcf_disc.wgsl")].into_iter().collect(),
        Pcf::Pcss => {
            let depth = if is_arrayed(key) {
                include_str!("../shaders/depth_many.wgsl")
            } else {
                include_str!("../shaders/depth_one.wgsl")
            };
            [TAP, disc::POINTS, depth, include_str!("../shaders/pcf_soft.wgsl")].into_iter().collect()
        }
    };
    // Stored depths are as linear as the law says.
    if key.filter.reads_depths() && key.shape == MapShape::Affine {
        fragments.push(include_str!("../shaders/law_linear.wgsl"));
    }
    fragments
}

/// Where a receiver is looked up, its bias applied.
fn look(key: WgslKey) -> ArrayVec<&'static str, 2> {
    let Texel::Moments(moments) = key.texel else {
        return core::iter::once(match key.shape {
            _ if key.filter.is_disc() => disc::look(key),
            MapShape::Affine => include_str!("../shaders/look_affine.wgsl"),
            MapShape::Projective | MapShape::ProjectiveDepth => include_str!("../shaders/look_projective.wgsl"),
        })
        .collect();
    };
    moments::look(moments, key.shape).into()
}

/// The number of maps, as the shader knows it, from 2 on.
const MAPS: [&str; MAX_VIEWS - 1] = [
    "const ANTUMBRA_MAPS: u32 = 2u;",
    "const ANTUMBRA_MAPS: u32 = 3u;",
    "const ANTUMBRA_MAPS: u32 = 4u;",
    "const ANTUMBRA_MAPS: u32 = 5u;",
    "const ANTUMBRA_MAPS: u32 = 6u;",
    "const ANTUMBRA_MAPS: u32 = 7u;",
    "const ANTUMBRA_MAPS: u32 = 8u;",
];

/// The caster stage alone, for the shader of a depth pass: `antumbra_caster(clip_from_render, position)`, and for
/// warped maps `antumbra_caster_depth(depth_from_render, position)`,
/// a varying that the fragment stage writes as its depth.
pub const CASTER: &str = include_str!("../shaders/caster.wgsl");

/// The debug view of aliasing, for engines that ask for it: append it to the text of [`module`] or [`library`].
/// `antumbra_footprint(view, side, position, d_position_dx, d_position_dy)` gives the texels over a pixel, of which 1
/// or more mean no aliasing; `antumbra_footprint_colour(texels_per_pixel)` gives an sRGB colour of that. The
/// derivatives are `dpdx(position)` and `dpdy(position)`; with one map, `view` is `antumbra_uniforms.view`, with
/// several found by depth `antumbra_uniforms.views[antumbra_index(view_depth)]`.
pub const FOOTPRINT: &str = include_str!("../shaders/footprint.wgsl");

/// The whole text of the passes that blur a picture's shadow term, for engines that do without the module `gpu`: vertex
/// entry point `antumbra_everything` (three vertices); fragment entry points `antumbra_eye_blur_along_row` and
/// `antumbra_eye_blur_along_column`. Bindings in group 0: 0 [`EyeBlurUniforms`](crate::EyeBlurUniforms), 1 the shadow
/// term, 2 the depth buffer.
pub const EYE_BLUR: &str =
    concat!(include_str!("../shaders/eye_blur.wgsl"), include_str!("../shaders/eye_blur_pass.wgsl"));

/// What an engine calls, for one map.
const ONE_MAP: &str = "
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    return antumbra_visible(antumbra_uniforms.view, antumbra_map, antumbra_compare, position, normal);
}
";

/// The lookup in two stages, for affine maps: what is linear in position can be computed at vertices.
const TWO_STAGES: &str = "
fn antumbra_place(position: vec3f, normal: vec3f) -> AntumbraLookup {
    return antumbra_lookup(antumbra_uniforms.view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
}

fn antumbra_lit(look: AntumbraLookup) -> f32 {
    return antumbra_filter(antumbra_map, antumbra_compare, look);
}
";

/// The whole text for an engine's shader: library, bindings, `antumbra_visibility`, and for one affine map the same in
/// two stages.
///
/// Cold path: call it when options change, not per frame.
#[must_use]
pub fn module(key: WgslKey, bindings: Bindings) -> String {
    let Bindings { group, first } = bindings;
    let [uniforms, map, compare] = [0, 1, 2].map(|offset| first.saturating_add(offset));
    let (texture, sampler) = (texture(key), sampler(key));
    let mut text = String::new();
    for fragment in library(key) {
        text.push_str(&fragment);
        text.push('\n');
    }
    let _ = write!(
        text,
        "@group({group}) @binding({uniforms}) var<uniform> antumbra_uniforms: AntumbraUniforms;\n\
         @group({group}) @binding({map}) var antumbra_map: {texture};\n\
         @group({group}) @binding({compare}) var antumbra_compare: {sampler};\n"
    );
    for part in calls(key) {
        text.push('\n');
        text.push_str(&part);
    }
    if key.has_two_stages() {
        text.push_str(TWO_STAGES);
    }
    text
}

/// The whole text of the passes that filter a map of depths into one of moments, for engines that do without the module
/// `gpu`: vertex entry point `antumbra_everything` (three vertices); fragment entry points `antumbra_blur_along_u`
/// (reads depths), `antumbra_blur_along_v` (reads what that wrote) and `antumbra_halve` (a level of mips from the one
/// above). Bindings in group 0: 0 [`BlurUniforms`](crate::BlurUniforms), 1 the depths, 2 what is stored.
///
/// For [sums](crate::MomentFormat::Summed) the fragment entry points are `antumbra_sum_depths` (reads depths, with a
/// stride of 1), then `antumbra_sum_along_u` with strides of 8, 64 and so on below the tile's side, then
/// `antumbra_sum_along_v` with strides of 1, 8 and so on; each reads what the one before it wrote.
#[must_use]
pub fn prefilter(moments: Moments) -> String {
    moments::prefilter(moments)
}

/// What an engine calls, and how it finds its map.
fn calls(key: WgslKey) -> ArrayVec<Cow<'static, str>, 4> {
    const INDEX: &str = include_str!("../shaders/select_index.wgsl");
    const ROOM: &str = include_str!("../shaders/select_room.wgsl");
    let mut calls = ArrayVec::new();
    if key.maps <= 1 {
        calls.extend(grazing::called(key, ONE_MAP));
        return calls;
    }
    let (how, call) = match (key.select, key.blend) {
        (Select::Depth, false) => (INDEX, include_str!("../shaders/select_depth.wgsl")),
        (Select::Depth, true) => (INDEX, include_str!("../shaders/select_depth_blend.wgsl")),
        (Select::Finest, false) => (ROOM, include_str!("../shaders/select_finest.wgsl")),
        (Select::Finest, true) => (ROOM, include_str!("../shaders/select_finest_blend.wgsl")),
    };
    calls.push(how.into());
    calls.extend(grazing::called(key, call));
    calls
}

impl WgslKey {
    /// Every key, for tests and for engines that build their pipelines up front.
    pub fn all() -> impl Iterator<Item = Self> {
        let depths = Pcf::ALL.into_iter().map(|filter| Self { filter, ..Self::default() });
        let moments = Moments::all().map(|moments| Self { texel: Texel::Moments(moments), ..Self::default() });
        let shaped = |key: Self| MapShape::ALL.into_iter().map(move |shape| Self { shape, ..key });
        depths
            .chain(moments)
            .flat_map(shaped)
            .flat_map(|key| {
                let many = (2..=MAX_VIEWS as u8).flat_map(move |maps| {
                    let ways = Select::ALL.into_iter().flat_map(|select| [(select, false), (select, true)]);
                    ways.map(move |(select, blend)| Self { maps, select, blend, ..key })
                });
                core::iter::once(key).chain(many)
            })
            .flat_map(|key| Grazing::ALL.map(|grazing| Self { grazing, ..key }))
    }

    /// Whether its text has the lookup in two stages, `antumbra_place` and `antumbra_lit`.
    #[must_use]
    pub fn has_two_stages(self) -> bool {
        let is_plain = self.texel == Texel::Depth && !self.filter.is_spread() && self.grazing == Grazing::Off;
        self.maps == 1 && self.shape == MapShape::Affine && is_plain
    }
}
