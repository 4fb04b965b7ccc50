// The same without noise.
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    return antumbra_visibility_noisy(position, normal, view_depth, 0.0);
}
