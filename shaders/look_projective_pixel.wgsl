// Where a receiver is looked up in a view, its bias applied, with the part of the map that its pixel covers.
fn antumbra_look(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
    var look = antumbra_lookup_projective(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
    look.spread = antumbra_spread(view, position, normal);
    return look;
}
