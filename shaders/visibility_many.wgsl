// Share of the light that reaches a point of render space, 0 to 1, by one of several maps. Beyond the map everything is
// lit: the texels at its rim are never drawn, and the sampler repeats them.
// normal: unit geometric normal, on the side that is looked at; zero turns the automatic bias off.
fn antumbra_visible(view: AntumbraView, layer: u32, map: texture_depth_2d_array, compare: sampler_comparison, position: vec3f, normal: vec3f) -> f32 {
    var look = antumbra_look(view, position, normal);
    look.layer = layer;
    return antumbra_filter(map, compare, look);
}
