// Receivers whose light is placed at their vertices: nothing else goes from stage to stage.
@vertex
fn put(@location(0) position: vec3f, @location(1) normal: vec4f) -> Lean {
    return Lean(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz));
}

@vertex
fn put_cut(@location(0) position: vec3f, @location(1) normal: vec4f, @location(2) uv: vec2f) -> LeanCut {
    return LeanCut(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz), uv);
}

fn light_of(at: vec3f) -> f32 {
    return light_at(at);
}
