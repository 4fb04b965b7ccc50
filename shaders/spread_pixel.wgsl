// How taps are spread around a receiver: over the pixel that shows it.
struct AntumbraSpread {
    // From the receiver to two of the four taps: texture coordinates (times w), w, and depth. The others lie opposite.
    first: vec4f,
    second: vec4f,
    // By how much either pair is nearer to the light than its plane is: where a surface ends within the pixel, its plane
    // goes on below the next one.
    lift: vec2f,
    // w at the receiver.
    w: f32,
    // What may be read without reading beyond what is drawn, texture coordinates.
    low: vec2f,
    high: vec2f,
}

// Below every length that is divided by.
const ANTUMBRA_SPREAD_SMALLEST: f32 = 1e-30;

// Below every w in view.
const ANTUMBRA_SPREAD_LEAST_W: f32 = 1e-6;

// Sine of the angle between normal and line of sight, squared, below which every direction in the surface is as good.
const ANTUMBRA_HEAD_ON: f32 = 1e-8;

// Cosine of that angle below which pixels are taken to be no longer on the surface: 20 times as long as wide.
const ANTUMBRA_LEAST_FACING: f32 = 0.05;

fn antumbra_spread(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraSpread {
    // From the eye, or along the view where that is parallel.
    let from_eye = position * view.moments.w - view.moments.xyz;
    let sight = from_eye / max(length(from_eye), ANTUMBRA_SPREAD_SMALLEST);
    // A pixel on the receiver's plane: as wide as it is across the line of sight, and longer at a slant.
    let size = dot(view.pixel_from_render, vec4f(position, 1.0));
    let level = cross(sight, normal);
    let axis = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(normal.x) > 0.7);
    let across = select(cross(normal, axis), level, dot(level, level) > ANTUMBRA_HEAD_ON);
    let wide = across * (size / max(length(across), ANTUMBRA_SPREAD_SMALLEST));
    let long = cross(normal, wide) / max(abs(dot(sight, normal)), ANTUMBRA_LEAST_FACING);
    // Four places out of sixteen, of which no two share a row or a column.
    let first = 0.375 * wide + 0.125 * long;
    let second = 0.375 * long - 0.125 * wide;
    let from_render = transpose(mat4x3f(
        view.u_from_render.xyz, view.v_from_render.xyz, view.w_from_render.xyz, view.depth_from_render.xyz,
    ));
    let w = max(dot(view.w_from_render, vec4f(position, 1.0)), ANTUMBRA_SPREAD_LEAST_W);
    let low = view.rect.xy + 0.5 * view.bias.w;
    let lift = vec2f(length(first), length(second)) * length(view.depth_from_render.xyz);
    return AntumbraSpread(from_render * first, from_render * second, lift, w, low, view.rect.zw - 0.5 * view.bias.w);
}
