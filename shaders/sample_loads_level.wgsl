// The same, of the one level that there is.
fn antumbra_stored_at(map: texture_2d<f32>, linear: sampler, look: AntumbraLookup) -> vec4f {
    return antumbra_stored_in(map, look, 0u);
}
