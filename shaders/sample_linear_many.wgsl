// What is stored around the place that is looked up. Beyond the map it is what its rim stores, as if there were no
// other map beside it: the centres of its rim are farther from that in smaller levels.
fn antumbra_stored_at(map: texture_2d_array<f32>, linear: sampler, look: AntumbraLookup) -> vec4f {
    let rim = antumbra_rim(map, look.level);
    return textureSampleLevel(map, linear, clamp(look.uv, look.low + rim, look.high - rim), look.layer, look.level);
}
