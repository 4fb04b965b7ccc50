// The light that arrives, and nothing done with it.
fn shade(light: f32, normal: vec3f) -> f32 {
    return light;
}
