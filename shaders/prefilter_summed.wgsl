@group(0) @binding(0) var<uniform> antumbra_blur: AntumbraBlur;
@group(0) @binding(1) var antumbra_depth: texture_depth_2d;
@group(0) @binding(2) var antumbra_stored: texture_2d<u32>;

// Texels that a pass adds.
const ANTUMBRA_SUMMED_TEXELS: i32 = 8;

// Steps of a number from 0 to 1.
const ANTUMBRA_BOX_STEPS: f32 = 65535.0;

// One triangle over everything.
@vertex
fn antumbra_everything(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// A depth that is one: anything else is as far as can be, which is lit.
fn antumbra_sound(depth: f32) -> f32 {
    return select(1.0, depth, depth >= 0.0 && depth <= 1.0);
}

// Numbers from 0 to 1 as integers.
fn antumbra_counted(stored: vec4f) -> vec4u {
    return vec4u(floor(clamp(stored, vec4f(0.0), vec4f(1.0)) * ANTUMBRA_BOX_STEPS + 0.5));
}

// From depths to what is stored of a texel and of those before it in u.
@fragment
fn antumbra_sum_depths(@builtin(position) at: vec4f) -> @location(0) vec4u {
    let corner = vec2i(antumbra_blur.tile.xy);
    let texel = vec2i(at.xy) - corner;
    var sum = vec4u();
    for (var x = texel.x; x >= 0 && x > texel.x - ANTUMBRA_SUMMED_TEXELS; x--) {
        let depth = textureLoad(antumbra_depth, corner + vec2i(x, texel.y), 0);
        sum += antumbra_counted(antumbra_store(antumbra_sound(depth)));
    }
    return sum;
}

// Sums of as many texels that end a stride apart, a step in u or in v: sums of so many times as many. What lies before
// the tile is none of it.
fn antumbra_sum(texel: vec2i, step: vec2i) -> vec4u {
    let corner = vec2i(antumbra_blur.tile.xy);
    var sum = vec4u();
    for (var index = 0; index < ANTUMBRA_SUMMED_TEXELS; index++) {
        let before = texel - corner - index * i32(antumbra_blur.stride) * step;
        if (min(before.x, before.y) < 0) {
            break;
        }
        sum += textureLoad(antumbra_stored, corner + before, 0);
    }
    return sum;
}

@fragment
fn antumbra_sum_along_u(@builtin(position) at: vec4f) -> @location(0) vec4u {
    return antumbra_sum(vec2i(at.xy), vec2i(1, 0));
}

@fragment
fn antumbra_sum_along_v(@builtin(position) at: vec4f) -> @location(0) vec4u {
    return antumbra_sum(vec2i(at.xy), vec2i(0, 1));
}
