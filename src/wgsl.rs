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
//! The same in two stages, for one affine map (uniform ones; see [`MapShape`]) and engines that want the cheapest
//! fragments:
//!
//! ```wgsl
//! fn antumbra_place(position: vec3f, normal: vec3f) -> AntumbraLookup   // in the vertex stage
//! fn antumbra_lit(look: AntumbraLookup) -> f32                          // in the fragment stage
//! ```
//!
//! `AntumbraLookup` has the members `uv: vec2f`, `depth: f32` and `slope: vec2f`, in this order; carry `uv` and `depth`
//! from stage to stage with perspective-correct interpolation, and `slope` only for [`Pcf::Box3x3`] and [`Pcf::Box5x5`]
//! (the other filters never read it: pass `vec2f()`). Then fragments load no uniforms and receive no normal.
//!
//! Kind of promise: exact, up to rounding, where all vertices of a triangle are given one normal, because all members
//! are then linear in position (`slope` is constant). With smooth normals the bias is interpolated: near enough on
//! triangles that are small beside the curvature, too little across large ones, where acne may show; those take
//! `antumbra_visibility`. Choose the side that is looked at from the eye position; all vertices of a face then agree.

mod moments;

use core::fmt::Write as _;
use std::borrow::Cow;

use arrayvec::ArrayVec;

use crate::frame::{MAX_VIEWS, MapShape, Pcf, Select, WgslKey};
use crate::texel::Moments;

/// Where the generated bindings go: `group`, and three binding numbers from `first` on (uniforms, map, sampler).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bindings {
    /// Bind group index.
    pub group: u32,
    /// First of [`BINDING_COUNT`] consecutive binding numbers.
    pub first: u32,
}

/// Number of bindings: the uniforms, the map, the comparison sampler.
pub const BINDING_COUNT: u32 = 3;

/// Most fragments of a key.
const MAX_FRAGMENTS: usize = 11;

/// The fragments of a key, in order; concatenated they are one valid module without bindings or entry points.
///
/// The texts live in the binary: no allocation for one map. For several, what reads the map reads an array of them
/// (`texture_depth_2d_array` in place of `texture_depth_2d`), and those texts are made anew.
#[must_use]
pub fn library(key: WgslKey) -> ArrayVec<Cow<'static, str>, MAX_FRAGMENTS> {
    let read = |text: &'static str| {
        if key.maps > 1 { text.replace("texture_depth_2d,", "texture_depth_2d_array,").into() } else { text.into() }
    };
    fragments(key).into_iter().map(read).collect()
}

fn fragments(key: WgslKey) -> ArrayVec<&'static str, MAX_FRAGMENTS> {
    let mut fragments = ArrayVec::new();
    // What is known of a map, and the maps.
    fragments.push(include_str!("../shaders/view.wgsl"));
    if key.maps > 1 {
        fragments.push(MAPS[usize::from(key.maps.min(MAX_VIEWS as u8)) - 2]);
        fragments.push(include_str!("../shaders/uniforms_many.wgsl"));
        fragments.push(include_str!("../shaders/map_many.wgsl"));
    } else {
        fragments.push(include_str!("../shaders/uniforms_one.wgsl"));
        fragments.push(include_str!("../shaders/map_one.wgsl"));
    }
    fragments.push(CASTER);
    // Where a receiver is looked up.
    match key.shape {
        MapShape::Affine => fragments.push(include_str!("../shaders/lookup.wgsl")),
        MapShape::Projective => fragments.push(include_str!("../shaders/law_linear.wgsl")),
        MapShape::ProjectiveDepth => fragments.push(include_str!("../shaders/law_projective.wgsl")),
    }
    if key.shape != MapShape::Affine {
        fragments.push(include_str!("../shaders/lookup_projective.wgsl"));
    }
    // What is read there.
    match key.filter {
        Pcf::Point => fragments.push(include_str!("../shaders/pcf_point.wgsl")),
        Pcf::Hardware2x2 => fragments.push(include_str!("../shaders/pcf_hardware.wgsl")),
        Pcf::Box3x3 => {
            fragments.push(TAP);
            fragments.push(include_str!("../shaders/pcf_box_three.wgsl"));
        }
        Pcf::Box5x5 => {
            fragments.push(TAP);
            fragments.push(include_str!("../shaders/pcf_box_five.wgsl"));
        }
    }
    fragments.push(match key.shape {
        MapShape::Affine => include_str!("../shaders/look_affine.wgsl"),
        MapShape::Projective | MapShape::ProjectiveDepth => include_str!("../shaders/look_projective.wgsl"),
    });
    fragments.push(if key.maps > 1 {
        include_str!("../shaders/visibility_many.wgsl")
    } else {
        include_str!("../shaders/visibility_one.wgsl")
    });
    fragments
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

const TAP: &str = include_str!("../shaders/pcf_tap.wgsl");

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
    let texture = if key.maps > 1 { "texture_depth_2d_array" } else { "texture_depth_2d" };
    let mut text = String::new();
    for fragment in library(key) {
        text.push_str(&fragment);
        text.push('\n');
    }
    let _ = write!(
        text,
        "@group({group}) @binding({uniforms}) var<uniform> antumbra_uniforms: AntumbraUniforms;\n\
         @group({group}) @binding({map}) var antumbra_map: {texture};\n\
         @group({group}) @binding({compare}) var antumbra_compare: sampler_comparison;\n"
    );
    for part in calls(key) {
        text.push('\n');
        text.push_str(part);
    }
    if key.maps == 1 && key.shape == MapShape::Affine {
        text.push_str(TWO_STAGES);
    }
    text
}

/// The whole text of the passes that filter a map of depths into one of moments, for engines that do without the module
/// `gpu`: vertex entry point `antumbra_everything` (three vertices); fragment entry points `antumbra_blur_along_u` (reads
/// depths), `antumbra_blur_along_v` (reads what that wrote) and `antumbra_halve` (a level of mips from the one above).
/// Bindings in group 0: 0 [`BlurUniforms`](crate::encoding::blur::BlurUniforms), 1 the depths, 2 what is stored.
#[must_use]
pub fn prefilter(moments: Moments) -> String {
    moments::prefilter(moments)
}

/// What an engine calls, and how it finds its map.
fn calls(key: WgslKey) -> ArrayVec<&'static str, 2> {
    const INDEX: &str = include_str!("../shaders/select_index.wgsl");
    const ROOM: &str = include_str!("../shaders/select_room.wgsl");
    let mut calls = ArrayVec::new();
    if key.maps <= 1 {
        calls.push(ONE_MAP);
        return calls;
    }
    let (how, call) = match (key.select, key.blend) {
        (Select::Depth, false) => (INDEX, include_str!("../shaders/select_depth.wgsl")),
        (Select::Depth, true) => (INDEX, include_str!("../shaders/select_depth_blend.wgsl")),
        (Select::Finest, false) => (ROOM, include_str!("../shaders/select_finest.wgsl")),
        (Select::Finest, true) => (ROOM, include_str!("../shaders/select_finest_blend.wgsl")),
    };
    calls.push(how);
    calls.push(call);
    calls
}

impl WgslKey {
    /// Every key, for tests and for engines that build their pipelines up front.
    pub fn all() -> impl Iterator<Item = Self> {
        let each_filter = |shape| Pcf::ALL.into_iter().map(move |filter| Self { filter, shape, ..Self::default() });
        MapShape::ALL.into_iter().flat_map(each_filter).flat_map(|key| {
            let many = (2..=MAX_VIEWS as u8).flat_map(move |maps| {
                let ways = Select::ALL.into_iter().flat_map(|select| [(select, false), (select, true)]);
                ways.map(move |(select, blend)| Self { maps, select, blend, ..key })
            });
            core::iter::once(key).chain(many)
        })
    }
}
