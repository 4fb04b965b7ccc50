// The depth in a texel; beyond the map it is that at its rim.
fn antumbra_stored_depth(map: texture_depth_2d, look: AntumbraLookup, texel: vec2f) -> f32 {
    let last = vec2f(textureDimensions(map)) - 1.0;
    return textureLoad(map, vec2i(clamp(texel, vec2f(0.0), last)), 0);
}
