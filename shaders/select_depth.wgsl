fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    let index = antumbra_index(view_depth);
    return antumbra_visible(antumbra_uniforms.views[index], antumbra_map, antumbra_compare, position, normal);
}
