// Share of the light by what is stored. A texel of a slanted plane is as spread as the plane is within it.
fn antumbra_read(stored: vec4f, depth: f32, slope: vec2f) -> f32 {
    let moments = antumbra_variance_unpacked(stored.xy);
    return antumbra_variance_lit(moments, depth, ANTUMBRA_VARIANCE_LOSS + 0.25 * dot(slope, slope));
}
