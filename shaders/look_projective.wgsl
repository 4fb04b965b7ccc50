// Where a receiver is looked up in a view, its bias applied.
fn antumbra_look(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
    return antumbra_lookup_projective(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
}
