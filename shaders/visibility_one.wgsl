// Share of the light that reaches a point of render space, 0 to 1. Beyond the map everything is lit: the texels at its
// rim are never drawn, and the sampler repeats them.
// normal: unit geometric normal, on the side that is looked at; zero turns the automatic bias off.
fn antumbra_visible(view: AntumbraView, map: texture_depth_2d, compare: sampler_comparison, position: vec3f, normal: vec3f) -> f32 {
    return antumbra_filter(map, compare, antumbra_look(view, position, normal));
}
