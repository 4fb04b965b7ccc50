// The first map that holds the receiver and what its filter reads: maps are listed from the finest on.
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    var index = 0u;
    var look = antumbra_look(antumbra_uniforms.views[index], position, normal);
    while (!(antumbra_room(antumbra_uniforms.views[index], look) >= 0.0)) {
        index++;
        if (index == ANTUMBRA_MAPS) {
            return 1.0;
        }
        look = antumbra_look(antumbra_uniforms.views[index], position, normal);
    }
    // Read once, after the search: processors that run both sides of a branch would read in every turn.
    return antumbra_filter(antumbra_map, antumbra_compare, antumbra_on_map(antumbra_uniforms.views[index], look));
}
