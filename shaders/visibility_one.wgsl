// Share of the light that reaches a point of render space, 0 to 1. Outside the map everything is lit.
// normal: unit geometric normal, on the side that is looked at; zero turns the automatic bias off.
fn antumbra_visible(view: AntumbraView, map: texture_depth_2d, compare: sampler_comparison, position: vec3f, normal: vec3f) -> f32 {
    let look = antumbra_lookup(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
    if all((look.uv >= view.rect.xy) & (look.uv <= view.rect.zw)) {
        return antumbra_filter(map, compare, look);
    }
    return 1.0;
}
