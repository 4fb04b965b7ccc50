// Receivers whose light is placed at their vertices, as an engine has them: shaded, with the normal beside the place.
@vertex
fn put(@location(0) position: vec3f, @location(1) normal: vec4f) -> Solid {
    let seen = towards_viewer(position, normal.xyz);
    return Solid(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz), seen);
}

@vertex
fn put_cut(@location(0) position: vec3f, @location(1) normal: vec4f, @location(2) uv: vec2f) -> Cut {
    let seen = towards_viewer(position, normal.xyz);
    return Cut(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz), seen, uv);
}

fn light_of(at: vec3f, normal: vec3f) -> f32 {
    return shade(light_at(at), normal);
}
