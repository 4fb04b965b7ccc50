// Receivers: visibility of the light alone.
fn visibility(position: vec3f, normal: vec3f) -> f32 {
    return antumbra_visibility(position, normal, dot(camera.view_depth, vec4f(position, 1.0)));
}

@fragment
fn receive(surface: Solid) -> @location(0) f32 {
    return visibility(surface.position, surface.normal);
}

@fragment
fn receive_cut(surface: Cut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return visibility(surface.position, surface.normal);
}
