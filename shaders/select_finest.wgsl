// The first map that holds the receiver and what its filter reads: maps are listed from the finest on.
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    for (var index = 0u; index < ANTUMBRA_MAPS; index++) {
        let look = antumbra_look(antumbra_uniforms.views[index], position, normal);
        if (antumbra_room(antumbra_uniforms.views[index], look) >= 0.0) {
            return antumbra_filter(antumbra_map, antumbra_compare, antumbra_on_map(antumbra_uniforms.views[index], look));
        }
    }
    return 1.0;
}
