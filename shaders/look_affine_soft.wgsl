// Where a receiver is looked up in a view, its bias applied, with a turn of the filter's disc. The bias is that of the
// widest disc; how much less narrower ones need is kept beside it.
fn antumbra_look_noisy(view: AntumbraView, position: vec3f, normal: vec3f, noise: f32) -> AntumbraLookup {
    var look = antumbra_lookup(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
    let near = antumbra_lookup(view, position, normal, ANTUMBRA_TAP_REACH, ANTUMBRA_TAP_REACH);
    look.spread = antumbra_spread(view, position, noise);
    look.spread.back = vec3f(near.uv - look.uv, near.depth - look.depth) / (ANTUMBRA_REACH - ANTUMBRA_TAP_REACH);
    return look;
}
