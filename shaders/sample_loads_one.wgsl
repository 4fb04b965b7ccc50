// What is stored around the place that is looked up in a level, from its four nearest texels: for formats that samplers
// do not interpolate.
fn antumbra_stored_in(map: texture_2d<f32>, look: AntumbraLookup, level: u32) -> vec4f {
    // Sizes of levels that differ from pixel to pixel are not asked for: some adapters answer all alike.
    let size = max(vec2i(textureDimensions(map)) >> vec2u(level), vec2i(1));
    let at = look.uv * vec2f(size) - 0.5;
    let first = vec2i(floor(at));
    let share = at - floor(at);
    let last = size - 1;
    let low = clamp(first, vec2i(0), last);
    let high = clamp(first + 1, vec2i(0), last);
    let above = mix(textureLoad(map, low, level), textureLoad(map, vec2i(high.x, low.y), level), share.x);
    let below = mix(textureLoad(map, vec2i(low.x, high.y), level), textureLoad(map, high, level), share.x);
    return mix(above, below, share.y);
}
