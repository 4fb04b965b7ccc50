// The library's lookup in one stage.
fn light(position: vec3f, normal: vec3f) -> f32 {
    return antumbra_visibility(position, normal, dot(camera.view_depth, vec4f(position, 1.0)));
}
