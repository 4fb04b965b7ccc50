// The first map that holds the receiver and what its filter reads: maps are listed from the finest on.
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    var view: AntumbraView;
    var look: AntumbraLookup;
    var index = 0u;
    loop {
        // Kept, not looked up again after the search: here all receivers of a group look at the same map, and share one
        // load; afterwards each has found its own.
        view = antumbra_uniforms.views[index];
        look = antumbra_look(view, position, normal);
        if (antumbra_room(view, look) >= 0.0) {
            break;
        }
        index++;
        if (index == ANTUMBRA_MAPS) {
            return 1.0;
        }
    }
    // Read once, after the search: processors that run both sides of a branch would read in every turn.
    return antumbra_filter(antumbra_map, antumbra_compare, antumbra_on_map(view, look));
}
