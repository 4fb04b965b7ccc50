// Receivers that look their light up at each fragment, from a position and a normal.
@fragment
fn receive(surface: Solid) -> @location(0) f32 {
    return shade(light(surface.position, surface.normal), surface.normal);
}

@fragment
fn receive_cut(surface: Cut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return shade(light(surface.position, surface.normal), surface.normal);
}
