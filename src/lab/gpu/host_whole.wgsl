// Receivers that look their light up at each fragment, from a position and a normal.
fn light_of(at: vec3f, normal: vec3f) -> f32 {
    return shade(light(at, normal), normal);
}
