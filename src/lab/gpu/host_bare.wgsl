// Receivers that look their light up at each fragment, from a position alone: nobody reads a normal.
@vertex
fn put(@location(0) position: vec3f) -> Lean {
    return Lean(camera.clip_from_render * vec4f(position, 1.0), position);
}

@vertex
fn put_cut(@location(0) position: vec3f, @location(2) uv: vec2f) -> LeanCut {
    return LeanCut(camera.clip_from_render * vec4f(position, 1.0), position, uv);
}

fn light_of(at: vec3f) -> f32 {
    return light(at, vec3f());
}
