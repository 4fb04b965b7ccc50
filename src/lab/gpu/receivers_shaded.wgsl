// Receivers as an engine has them: the light that arrives, shaded.
fn shaded(position: vec3f, normal: vec3f) -> f32 {
    return shade(antumbra_visibility(position, normal, dot(camera.view_depth, vec4f(position, 1.0))), normal);
}

@fragment
fn receive(surface: Solid) -> @location(0) f32 {
    return shaded(surface.position, surface.normal);
}

@fragment
fn receive_cut(surface: Cut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return shaded(surface.position, surface.normal);
}
