// How taps are spread around a receiver: over the pixel that shows it, on a warped map.
struct AntumbraSpread {
    // From the receiver to two of the four taps: texture coordinates (times w), w, and depth. The others lie opposite.
    first: vec4f,
    second: vec4f,
    // By how much either pair is nearer to the light than its plane is: where a surface ends within the pixel, its plane
    // goes on below the next one.
    lift: vec2f,
    // What may be read without reading beyond what is drawn, texture coordinates.
    low: vec2f,
    high: vec2f,
    // w at the receiver.
    w: f32,
}

// Below every w in view.
const ANTUMBRA_SPREAD_LEAST_W: f32 = 1e-6;

fn antumbra_spread(view: AntumbraView, position: vec3f, pixel: AntumbraPixel) -> AntumbraSpread {
    let from_render = transpose(mat4x3f(
        view.u_from_render.xyz, view.v_from_render.xyz, view.w_from_render.xyz, view.depth_from_render.xyz,
    ));
    let lift = pixel.distance * length(view.depth_from_render.xyz);
    let low = view.rect.xy + 0.5 * view.bias.w;
    let high = view.rect.zw - 0.5 * view.bias.w;
    let w = max(dot(view.w_from_render, vec4f(position, 1.0)), ANTUMBRA_SPREAD_LEAST_W);
    return AntumbraSpread(from_render * pixel.first, from_render * pixel.second, lift, low, high, w);
}

// A place on the map that is a step away: u, v, and depth.
fn antumbra_pixel_place(look: AntumbraLookup, step: vec4f, lift: f32) -> vec3f {
    let w = look.spread.w + step.z;
    let depth = look.depth / antumbra_law(look.spread.w) + step.w - lift;
    return vec3f((look.uv * look.spread.w + step.xy) / w, depth * antumbra_law(w));
}

// Two bilinear comparisons of points of the receiver's plane, a step to either side: of u, v (times w), w, and depth;
// lifted towards the light. Where the map does not reach as far both are of the receiver itself.
fn antumbra_pixel_pair(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup, step: vec4f, lift: f32) -> f32 {
    let here = vec3f(look.uv, look.depth);
    let there = antumbra_pixel_place(look, step, lift);
    let opposite = antumbra_pixel_place(look, -step, lift);
    let low = min(there.xy, opposite.xy);
    let high = max(there.xy, opposite.xy);
    let near = abs(step.z) < 0.5 * look.spread.w;
    let held = near && all(low >= look.spread.low) && all(high <= look.spread.high);
    let one = select(here, there, held);
    let other = select(here, opposite, held);
    return antumbra_sample(map, compare, look, one.xy, one.z) + antumbra_sample(map, compare, look, other.xy, other.z);
}
