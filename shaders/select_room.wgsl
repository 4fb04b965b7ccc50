// Texture coordinates from a place in a map to the nearest rim of what may be looked up there: negative outside, and
// where the map does not reach as deep as the receiver. The last map has no rim.
fn antumbra_room(view: AntumbraView, look: AntumbraLookup) -> f32 {
    let room = min(look.uv - view.rect.xy, view.rect.zw - look.uv) - view.domain.z;
    return select(-1.0, min(room.x, room.y), look.depth <= 1.0 - min(view.domain.z, 0.0));
}
