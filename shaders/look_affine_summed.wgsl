// Where a receiver is looked up in a view, its bias applied, and how wide.
fn antumbra_look(view: AntumbraView, position: vec3f, normal: vec3f) -> AntumbraLookup {
    var look = antumbra_lookup(view, position, normal, ANTUMBRA_REACH, ANTUMBRA_TAP_REACH);
    look.low = view.rect.xy - 0.5 * view.bias.w;
    look.high = view.rect.zw + 0.5 * view.bias.w;
    look.radius = antumbra_half_widths(view, position, look.uv);
    look.dark = view.moments.x;
    return look;
}
