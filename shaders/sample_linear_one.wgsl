// What is stored around the place that is looked up.
fn antumbra_stored_at(map: texture_2d<f32>, linear: sampler, look: AntumbraLookup) -> vec4f {
    return textureSampleLevel(map, linear, look.uv, look.level);
}
