// What a texel of the filtered map stores of a depth.
fn antumbra_store(depth: f32) -> vec4f {
    return vec4f(antumbra_variance_packed(antumbra_variance_moments(depth)), 0.0, 0.0);
}
