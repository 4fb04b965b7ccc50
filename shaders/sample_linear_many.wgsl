// What is stored around the place that is looked up. Beyond the map it is what its rim stores, as if there were no other
// map beside it.
fn antumbra_stored_at(map: texture_2d_array<f32>, linear: sampler, look: AntumbraLookup) -> vec4f {
    return textureSampleLevel(map, linear, clamp(look.uv, look.low, look.high), look.layer, look.level);
}
