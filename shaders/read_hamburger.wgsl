// Share of the light by what is stored.
fn antumbra_read(stored: vec4f, depth: f32, slope: vec2f) -> f32 {
    return antumbra_moments_lit(stored, depth, ANTUMBRA_MOMENTS_MIXED);
}
