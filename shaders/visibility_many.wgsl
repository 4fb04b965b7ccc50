// Where a view's map is: its layer, and the centres of the texels around what is drawn.
fn antumbra_on_map(view: AntumbraView, look: AntumbraLookup) -> AntumbraLookup {
    var on_map = look;
    on_map.layer = u32(view.across_u.w);
    on_map.low = view.rect.xy - 0.5 * view.bias.w;
    on_map.high = view.rect.zw + 0.5 * view.bias.w;
    return on_map;
}

// Share of the light that reaches a point of render space, 0 to 1, by one of several maps. Beyond the map everything is
// lit: the texels at its rim are never drawn, and are read there.
// normal: unit geometric normal, on the side that is looked at; zero turns the automatic bias off.
fn antumbra_visible(view: AntumbraView, map: texture_depth_2d_array, compare: sampler_comparison, position: vec3f, normal: vec3f) -> f32 {
    return antumbra_filter(map, compare, antumbra_on_map(view, antumbra_look(view, position, normal)));
}
