@group(0) @binding(0) var<uniform> antumbra_blur: AntumbraBlur;
@group(0) @binding(1) var antumbra_depth: texture_depth_2d;
@group(0) @binding(2) var antumbra_stored: texture_2d<f32>;

// One triangle over everything.
@vertex
fn antumbra_everything(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// A depth that is one: anything else is as far as can be, which is lit.
fn antumbra_sound(depth: f32) -> f32 {
    return select(1.0, depth, depth >= 0.0 && depth <= 1.0);
}

// Place in a tile that stays in it.
fn antumbra_in_tile(texel: vec2i) -> vec2i {
    return vec2i(antumbra_blur.tile.xy) + clamp(texel, vec2i(0), vec2i(i32(antumbra_blur.tile.z) - 1));
}

// From depths to what is stored, averaged along u.
@fragment
fn antumbra_blur_along_u(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let texel = vec2i(at.xy) - vec2i(antumbra_blur.tile.xy);
    let radius = antumbra_blur_radius(antumbra_blur, vec2f(texel)).x;
    let bell = antumbra_blur.bell != 0u;
    let reach = antumbra_blur_reach(radius, bell);
    var mean = AntumbraMean(vec4f(), 0.0);
    for (var offset = -reach; offset <= reach; offset++) {
        let depth = textureLoad(antumbra_depth, antumbra_in_tile(texel + vec2i(offset, 0)), 0);
        mean = antumbra_mean_with(mean, antumbra_store(antumbra_sound(depth)), antumbra_blur_weight(f32(offset), radius, bell));
    }
    return antumbra_mean(mean);
}

// What is stored, averaged along v.
@fragment
fn antumbra_blur_along_v(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let texel = vec2i(at.xy) - vec2i(antumbra_blur.tile.xy);
    let radius = antumbra_blur_radius(antumbra_blur, vec2f(texel)).y;
    let bell = antumbra_blur.bell != 0u;
    let reach = antumbra_blur_reach(radius, bell);
    var mean = AntumbraMean(vec4f(), 0.0);
    for (var offset = -reach; offset <= reach; offset++) {
        let stored = textureLoad(antumbra_stored, antumbra_in_tile(texel + vec2i(0, offset)), 0);
        mean = antumbra_mean_with(mean, stored, antumbra_blur_weight(f32(offset), radius, bell));
    }
    return antumbra_mean(mean);
}

// A level of the mip chain from the one above it: four texels each.
@fragment
fn antumbra_halve(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let first = 2 * vec2i(at.xy);
    let last = vec2i(textureDimensions(antumbra_stored)) - 1;
    var mean = AntumbraMean(vec4f(), 0.0);
    for (var index = 0; index < 4; index++) {
        let texel = min(first + vec2i(index & 1, index >> 1u), last);
        mean = antumbra_mean_with(mean, textureLoad(antumbra_stored, texel, 0), 1.0);
    }
    return antumbra_mean(mean);
}
