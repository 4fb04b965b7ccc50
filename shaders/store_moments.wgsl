// What a texel of the filtered map stores of a depth.
fn antumbra_store(depth: f32) -> vec4f {
    return antumbra_moments(depth);
}
