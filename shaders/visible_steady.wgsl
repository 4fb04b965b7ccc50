// The same without noise.
fn antumbra_visible(view: AntumbraView, map: texture_depth_2d, compare: sampler_comparison, position: vec3f, normal: vec3f) -> f32 {
    return antumbra_visible_noisy(view, map, compare, position, normal, 0.0);
}
