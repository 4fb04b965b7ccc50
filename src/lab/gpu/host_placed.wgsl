// Receivers whose light is placed at their vertices: nothing else goes from stage to stage.
struct Placed {
    @builtin(position) @invariant clip: vec4f,
    @location(0) place: vec3f,
}

struct PlacedCut {
    @builtin(position) @invariant clip: vec4f,
    @location(0) place: vec3f,
    @location(1) uv: vec2f,
}

@vertex
fn put(@location(0) position: vec3f, @location(1) normal: vec4f) -> Placed {
    return Placed(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz));
}

@vertex
fn put_cut(@location(0) position: vec3f, @location(1) normal: vec4f, @location(2) uv: vec2f) -> PlacedCut {
    return PlacedCut(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz), uv);
}

@fragment
fn receive(surface: Placed) -> @location(0) f32 {
    return light_at(surface.place);
}

@fragment
fn receive_cut(surface: PlacedCut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return light_at(surface.place);
}
