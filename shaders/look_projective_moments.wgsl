// Where a receiver is looked up in a view, its bias applied.
fn antumbra_look(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
    var look = antumbra_lookup_projective(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
    look.dark = view.moments.x;
    look.level = antumbra_level(view, position);
    return look;
}
