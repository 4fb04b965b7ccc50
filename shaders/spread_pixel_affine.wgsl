// How taps are spread around a receiver: over the pixel that shows it, on a uniform map.
struct AntumbraSpread {
    // From the receiver to two of the four taps: texture coordinates and depth. The others lie opposite.
    first: vec3f,
    second: vec3f,
    // By how much either pair is nearer to the light than its plane is: where a surface ends within the pixel, its plane
    // goes on below the next one.
    lift: vec2f,
    // What may be read without reading beyond what is drawn, texture coordinates.
    low: vec2f,
    high: vec2f,
}

fn antumbra_spread(view: AntumbraView, position: vec3f, pixel: AntumbraPixel) -> AntumbraSpread {
    let from_render = transpose(mat3x3f(view.u_from_render.xyz, view.v_from_render.xyz, view.depth_from_render.xyz));
    let lift = pixel.distance * length(view.depth_from_render.xyz);
    let low = view.rect.xy + 0.5 * view.bias.w;
    let high = view.rect.zw - 0.5 * view.bias.w;
    return AntumbraSpread(from_render * pixel.first, from_render * pixel.second, lift, low, high);
}

// Two bilinear comparisons of points of the receiver's plane, a step to either side, lifted towards the light. Where the
// map does not reach as far both are of the receiver itself.
fn antumbra_pixel_pair(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup, step: vec3f, lift: f32) -> f32 {
    let room = min(look.uv - look.spread.low, look.spread.high - look.uv);
    let by = select(vec4f(), vec4f(step, lift), all(abs(step.xy) <= room));
    let depth = look.depth - by.w;
    return antumbra_sample(map, compare, look, look.uv + by.xy, depth + by.z)
        + antumbra_sample(map, compare, look, look.uv - by.xy, depth - by.z);
}
