// What the filter has to know of a view.
struct AntumbraBlur {
    // Its texels in the layer: first x and y, side; and the layer's side.
    tile: vec4u,
    // What the world steps from texel to texel are made of, x to z: w² (v - v w) in u and w² (u w - u) in v, of these
    // rows.
    across_u: vec4f,
    across_v: vec4f,
    across_w: vec4f,
    // One over w at texture coordinates: dot(row.xyz, (u, v, 1)).
    inverse_w: vec4f,
    // Half the width of the box that is averaged: world units where that is not negative, else texels, negated.
    radius: f32,
    // Whether it is a bell of the same deviation instead.
    bell: u32,
    // First term of a series.
    first_term: u32,
    // Texels between those that a pass adds, for what is summed.
    stride: u32,
}

// Half-width of the box in texels of u and v at a texel of the tile, whose world size differs from texel to texel of a
// warped map.
fn antumbra_blur_radius(blur: AntumbraBlur, texel: vec2f) -> vec2f {
    let uv = (vec2f(blur.tile.xy) + texel + 0.5) / f32(blur.tile.w);
    let inverse_w = max(dot(blur.inverse_w.xyz, vec3f(uv, 1.0)), ANTUMBRA_BLUR_SMALLEST);
    let step_u = blur.across_v.xyz - uv.y * blur.across_w.xyz;
    let step_v = uv.x * blur.across_w.xyz - blur.across_u.xyz;
    let steps = max(vec2f(length(step_u), length(step_v)), vec2f(ANTUMBRA_BLUR_SMALLEST));
    let texels = blur.radius * inverse_w * inverse_w / steps;
    // Towards the rim it narrows: what is not drawn is not known.
    let room = min(texel, f32(blur.tile.z) - 1.0 - texel) - 1.0;
    let most = clamp(room / select(1.0, ANTUMBRA_BLUR_BELL_REACH, blur.bell != 0u), vec2f(0.0), vec2f(ANTUMBRA_BLUR_MOST));
    return min(select(vec2f(-blur.radius), texels, blur.radius >= 0.0), most);
}

// Most texels of a half-width: more cost more than they are worth.
const ANTUMBRA_BLUR_MOST: f32 = 32.0;

// Below every step between texels.
const ANTUMBRA_BLUR_SMALLEST: f32 = 1e-30;

// How many texels to either side weigh anything.
fn antumbra_blur_reach(radius: f32, bell: bool) -> i32 {
    return i32(ceil(select(radius, radius * ANTUMBRA_BLUR_BELL_REACH, bell) - 0.5));
}

// A bell ends at this many half-widths of the box that deviates as much, which is 2.5 of its own deviations.
const ANTUMBRA_BLUR_BELL_REACH: f32 = 1.44;

// Weight of a texel at an offset: its overlap with the box, times the height of the bell. Texels come and go by parts
// as the radius changes: where it is rounded does not show.
fn antumbra_blur_weight(offset: f32, radius: f32, bell: bool) -> f32 {
    let reach = select(radius, radius * ANTUMBRA_BLUR_BELL_REACH, bell);
    let overlap = clamp(reach + 0.5 - abs(offset), 0.0, 1.0);
    if (bell) {
        let share = offset / max(radius, 0.5);
        return exp(-1.5 * share * share) * overlap;
    }
    return overlap;
}
