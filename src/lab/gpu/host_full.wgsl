// Fragments of hosts that carry a normal: `light_of(at, normal)` is the host's.
@fragment
fn receive(surface: Solid) -> @location(0) f32 {
    return light_of(surface.at, surface.normal);
}

@fragment
fn receive_cut(surface: Cut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return light_of(surface.at, surface.normal);
}
