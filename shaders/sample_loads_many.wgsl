// What is stored around the place that is looked up in a level, from its four nearest texels: for formats that samplers
// do not interpolate. Beyond the map it is what its rim stores, as if there were no other map beside it:
// the centres of its rim are farther from that in smaller levels.
fn antumbra_stored_in(map: texture_2d_array<f32>, look: AntumbraLookup, level: u32) -> vec4f {
    // Sizes of levels that differ from pixel to pixel are not asked for: some adapters answer all alike.
    let size = max(vec2i(textureDimensions(map)) >> vec2u(level), vec2i(1));
    let rim = antumbra_rim(map, look.level);
    let at = clamp(look.uv, look.low + rim, look.high - rim) * vec2f(size) - 0.5;
    let first = vec2i(floor(at));
    let share = at - floor(at);
    let last = size - 1;
    let low = clamp(first, vec2i(0), last);
    let high = clamp(first + 1, vec2i(0), last);
    let above = mix(textureLoad(map, low, look.layer, level), textureLoad(map, vec2i(high.x, low.y), look.layer, level), share.x);
    let below = mix(textureLoad(map, vec2i(low.x, high.y), look.layer, level), textureLoad(map, high, look.layer, level), share.x);
    return mix(above, below, share.y);
}
