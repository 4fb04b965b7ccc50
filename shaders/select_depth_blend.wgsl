fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    let index = antumbra_index(view_depth);
    let lit = antumbra_visible(antumbra_uniforms.views[index], antumbra_map, antumbra_compare, position, normal);
    // Towards its end a view gives way to the next one, and the last one to the light.
    let domain = antumbra_uniforms.views[index].domain;
    let share = clamp((view_depth - domain.z) * domain.w, 0.0, 1.0);
    if (share == 0.0) {
        return lit;
    }
    var next = 1.0;
    if (index + 1u < ANTUMBRA_MAPS) {
        next = antumbra_visible(antumbra_uniforms.views[index + 1u], antumbra_map, antumbra_compare, position, normal);
    }
    return mix(lit, next, share);
}
