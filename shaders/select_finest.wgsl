// Texture coordinates from a place in a map to the nearest rim of what may be looked up there: negative outside, and where
// the map does not reach as deep as the receiver. The last map has no rim.
fn antumbra_room(view: AntumbraView, look: AntumbraLookup) -> f32 {
    let room = min(look.uv - view.rect.xy, view.rect.zw - look.uv) - view.domain.z;
    return select(-1.0, min(room.x, room.y), look.depth <= 1.0 - min(view.domain.z, 0.0));
}

// The first map that holds the receiver and what its filter reads: maps are listed from the finest on.
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    for (var index = 0u; index < ANTUMBRA_MAPS; index++) {
        var look = antumbra_look(antumbra_uniforms.views[index], position, normal);
        if (antumbra_room(antumbra_uniforms.views[index], look) >= 0.0) {
            look.layer = index;
            return antumbra_filter(antumbra_map, antumbra_compare, look);
        }
    }
    return 1.0;
}
