// The same, between two levels.
fn antumbra_stored_at(map: texture_2d<f32>, linear: sampler, look: AntumbraLookup) -> vec4f {
    let level = u32(look.level);
    let share = look.level - f32(level);
    let fine = antumbra_stored_in(map, look, level);
    if (share == 0.0) {
        return fine;
    }
    return mix(fine, antumbra_stored_in(map, look, level + 1u), share);
}
