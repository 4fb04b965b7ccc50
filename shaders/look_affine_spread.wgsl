// Where a receiver is looked up in a view, its bias applied, with a turn of the filter's disc.
fn antumbra_look_noisy(view: AntumbraView, position: vec3f, normal: vec3f, noise: f32) -> AntumbraLookup {
    var look = antumbra_lookup(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
    look.spread = antumbra_spread(view, position, noise);
    return look;
}
