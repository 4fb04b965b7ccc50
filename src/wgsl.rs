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
//! at, `view_depth` the eye depth (used by techniques with several maps). The value is the share of light that arrives.
//!
//! The same in two stages, for affine maps (uniform ones; see [`MapShape`]) and engines that want the cheapest
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

use core::fmt::Write as _;

use arrayvec::ArrayVec;

use crate::frame::{MapShape, Pcf, WgslKey};

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
const MAX_FRAGMENTS: usize = 8;

/// The fragments of a key, in order; concatenated they are one valid module without bindings or entry points.
///
/// The texts live in the binary: no allocation.
#[must_use]
pub fn library(key: WgslKey) -> ArrayVec<&'static str, MAX_FRAGMENTS> {
    let mut fragments = ArrayVec::new();
    fragments.push(include_str!("../shaders/view.wgsl"));
    fragments.push(include_str!("../shaders/uniforms_one.wgsl"));
    fragments.push(CASTER);
    match key.shape {
        MapShape::Affine => fragments.push(include_str!("../shaders/lookup.wgsl")),
        MapShape::Projective => fragments.push(include_str!("../shaders/law_linear.wgsl")),
        MapShape::ProjectiveDepth => fragments.push(include_str!("../shaders/law_projective.wgsl")),
    }
    if key.shape != MapShape::Affine {
        fragments.push(include_str!("../shaders/lookup_projective.wgsl"));
    }
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
        MapShape::Affine => include_str!("../shaders/visibility_one.wgsl"),
        MapShape::Projective | MapShape::ProjectiveDepth => include_str!("../shaders/visibility_one_projective.wgsl"),
    });
    fragments
}

/// The caster stage alone, for the shader of a depth pass: `antumbra_caster(clip_from_render, position)`, and for
/// warped maps `antumbra_caster_depth(depth_from_render, position)`,
/// a varying that the fragment stage writes as its depth.
pub const CASTER: &str = include_str!("../shaders/caster.wgsl");

/// The debug view of aliasing, for engines that ask for it: append it to the text of [`module`] or [`library`].
/// `antumbra_footprint(view, side, position, d_position_dx, d_position_dy)` gives the texels over a pixel, of which 1
/// or more mean no aliasing; `antumbra_footprint_colour(texels_per_pixel)` gives an sRGB colour of that. The
/// derivatives are `dpdx(position)` and `dpdy(position)`; with one map, `view` is `antumbra_uniforms.view`.
pub const FOOTPRINT: &str = include_str!("../shaders/footprint.wgsl");

const TAP: &str = include_str!("../shaders/pcf_tap.wgsl");

/// The lookup in two stages, for affine maps: what is linear in position can be computed at vertices.
const TWO_STAGES: &str = "
fn antumbra_place(position: vec3f, normal: vec3f) -> AntumbraLookup {
    return antumbra_lookup(antumbra_uniforms.view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
}

fn antumbra_lit(look: AntumbraLookup) -> f32 {
    return antumbra_filter(antumbra_map, antumbra_compare, look);
}
";

/// The whole text for an engine's shader: library, bindings, `antumbra_visibility`, and for affine maps the same in two
/// stages.
///
/// Cold path: call it when options change, not per frame.
#[must_use]
pub fn module(key: WgslKey, bindings: Bindings) -> String {
    let Bindings { group, first } = bindings;
    let [uniforms, map, compare] = [0, 1, 2].map(|offset| first.saturating_add(offset));
    let mut text = String::new();
    for fragment in library(key) {
        text.push_str(fragment);
        text.push('\n');
    }
    let _ = write!(
        text,
        "@group({group}) @binding({uniforms}) var<uniform> antumbra_uniforms: AntumbraUniforms;\n\
         @group({group}) @binding({map}) var antumbra_map: texture_depth_2d;\n\
         @group({group}) @binding({compare}) var antumbra_compare: sampler_comparison;\n\
         \n\
         fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {{\n\
         \x20   return antumbra_visible(antumbra_uniforms.view, antumbra_map, antumbra_compare, position, normal);\n\
         }}\n"
    );
    if key.shape == MapShape::Affine {
        text.push_str(TWO_STAGES);
    }
    text
}

impl WgslKey {
    /// Every key, for tests and for engines that build their pipelines up front.
    pub fn all() -> impl Iterator<Item = Self> {
        MapShape::ALL.into_iter().flat_map(|shape| Pcf::ALL.into_iter().map(move |filter| Self { filter, shape }))
    }
}
