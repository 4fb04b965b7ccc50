// Receivers that look their light up at each fragment, from a position alone: nobody reads a normal.
struct Bare {
    @builtin(position) @invariant clip: vec4f,
    @location(0) position: vec3f,
}

struct BareCut {
    @builtin(position) @invariant clip: vec4f,
    @location(0) position: vec3f,
    @location(1) uv: vec2f,
}

@vertex
fn put(@location(0) position: vec3f) -> Bare {
    return Bare(camera.clip_from_render * vec4f(position, 1.0), position);
}

@vertex
fn put_cut(@location(0) position: vec3f, @location(2) uv: vec2f) -> BareCut {
    return BareCut(camera.clip_from_render * vec4f(position, 1.0), position, uv);
}

@fragment
fn receive(surface: Bare) -> @location(0) f32 {
    return light(surface.position, vec3f());
}

@fragment
fn receive_cut(surface: BareCut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return light(surface.position, vec3f());
}
