// Where a receiver is looked up in a view, its bias applied.
fn antumbra_look(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
    let level = antumbra_level(view, position);
    // Texels of smaller levels are spread over more of a slanted plane.
    let wider = view.moments.z * (exp2(level) - 1.0);
    var look = antumbra_lookup_projective(view, position, normal, ANTUMBRA_REACH + wider, ANTUMBRA_TAP_REACH + wider);
    look.dark = view.moments.x;
    look.level = level;
    return look;
}
