// Share of the light by what is stored.
fn antumbra_read(stored: vec4f, depth: f32, slope: vec2f) -> f32 {
    return antumbra_exponential_lit(stored.x, depth, ANTUMBRA_EXPONENT);
}
