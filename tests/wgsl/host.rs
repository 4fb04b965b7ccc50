//! Shaders that an engine would write around the library's text.

use antumbra::wgsl::{self, Bindings};
use antumbra::{MapShape, WgslKey};

/// An engine's shader around `antumbra_visibility`, with names that an engine would choose, and what a shape adds to
/// it.
pub(crate) fn host(key: WgslKey, bindings: Bindings) -> String {
    let engine = "
        struct View { clip_from_world: mat4x4f, depth_from_world: vec4f, eye: vec4f }
        struct Lookup { uv: vec2f }
        @group(0) @binding(0) var<uniform> view: View;
        @group(0) @binding(1) var map: texture_2d<f32>;
        @group(0) @binding(2) var compare: sampler;
        struct Fragment { @builtin(position) clip: vec4f, @location(0) position: vec3f, @location(1) normal: vec3f }
        fn lookup(at: Lookup) -> vec4f { return textureSampleLevel(map, compare, at.uv, 0.0); }
        fn filter_colour(colour: vec4f) -> vec4f { return colour * colour; }
        @vertex fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Fragment {
            return Fragment(view.clip_from_world * vec4f(position, 1.0), position, normal);
        }
        @fragment fn fragment(in: Fragment) -> @location(0) vec4f {
            let visible = antumbra_visibility(in.position, normalize(in.normal), distance(view.eye.xyz, in.position));
            return filter_colour(lookup(Lookup(in.position.xy))) * visible;
        }";
    [wgsl::module(key, bindings).as_str(), engine, &stages(key, "view.clip_from_world", "view.depth_from_world")]
        .concat()
}

/// Whether a key's lookup can be split over two stages.
pub(crate) fn has_two_stages(key: WgslKey) -> bool {
    key.has_two_stages()
}

/// Stages around everything else that a key has, given the names of the host's matrix and row of depth. Casters of an
/// affine map are vertices alone, and the lookup in one of them can be split over two stages. Casters of a warped map
/// carry their linear depth from the vertices to the fragments, which write it.
pub(crate) fn stages(key: WgslKey, matrix: &str, depth_row: &str) -> String {
    let text = match key.shape {
        MapShape::Affine if has_two_stages(key) => {
            "
        @vertex fn caster(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(MATRIX, position);
        }
        struct Placed {
            @builtin(position) clip: vec4f,
            @location(0) place: vec3f,
            @location(1) @interpolate(flat) slope: vec2f,
        }
        @vertex fn placing(@location(0) position: vec3f, @location(1) normal: vec3f) -> Placed {
            let look = antumbra_place(position, normal);
            return Placed(MATRIX * vec4f(position, 1.0), vec3f(look.uv, look.depth), look.slope);
        }
        @fragment fn placed(in: Placed) -> @location(0) vec4f {
            return vec4f(antumbra_lit(AntumbraLookup(in.place.xy, in.place.z, in.slope)));
        }"
        }
        MapShape::Affine | MapShape::ProjectiveDepth => {
            "
        @vertex fn caster(@location(0) position: vec3f) -> @builtin(position) vec4f {
            return antumbra_caster(MATRIX, position);
        }"
        }
        MapShape::Projective => {
            "
        struct Thrown { @builtin(position) clip: vec4f, @location(0) depth: f32 }
        @vertex fn caster(@location(0) position: vec3f) -> Thrown {
            return Thrown(antumbra_caster(MATRIX, position), antumbra_caster_depth(DEPTH_ROW, position));
        }
        @fragment fn thrown(in: Thrown) -> @builtin(frag_depth) f32 {
            return in.depth;
        }"
        }
    };
    text.replace("MATRIX", matrix).replace("DEPTH_ROW", depth_row)
}

/// The entry points of [`host`], all of them.
pub(crate) fn entries(key: WgslKey) -> &'static [&'static str] {
    match key.shape {
        MapShape::Affine if has_two_stages(key) => &["vertex", "fragment", "caster", "placing", "placed"],
        MapShape::Projective => &["vertex", "fragment", "caster", "thrown"],
        MapShape::Affine | MapShape::ProjectiveDepth => &["vertex", "fragment", "caster"],
    }
}

/// The entry points that look a receiver up.
pub(crate) fn lookups(key: WgslKey) -> &'static [&'static str] {
    if has_two_stages(key) { &["fragment", "placing", "placed"] } else { &["fragment"] }
}

/// Where engines put the bindings: at the front, in between, and far back.
pub(crate) const PLACES: [Bindings; 3] =
    [Bindings { group: 1, first: 0 }, Bindings { group: 0, first: 7 }, Bindings { group: 3, first: 900 }];
