// The depth in a texel; beyond the map it is that at its rim, as if there were no other map beside it.
fn antumbra_stored_depth(map: texture_depth_2d_array, look: AntumbraLookup, texel: vec2f) -> f32 {
    let size = vec2f(textureDimensions(map));
    let low = max(floor(look.low * size), vec2f(0.0));
    let high = min(floor(look.high * size), size - 1.0);
    return textureLoad(map, vec2i(clamp(texel, low, high)), look.layer, 0);
}
