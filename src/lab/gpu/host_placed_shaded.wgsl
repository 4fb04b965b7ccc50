// The same as an engine has them: shaded, with the normal beside the place of the light.
struct Placed {
    @builtin(position) @invariant clip: vec4f,
    @location(0) place: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
}

struct PlacedCut {
    @builtin(position) @invariant clip: vec4f,
    @location(0) place: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
    @location(2) uv: vec2f,
}

@vertex
fn put(@location(0) position: vec3f, @location(1) normal: vec4f) -> Placed {
    let seen = towards_viewer(position, normal.xyz);
    return Placed(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz), seen);
}

@vertex
fn put_cut(@location(0) position: vec3f, @location(1) normal: vec4f, @location(2) uv: vec2f) -> PlacedCut {
    let seen = towards_viewer(position, normal.xyz);
    return PlacedCut(camera.clip_from_render * vec4f(position, 1.0), place_light(position, normal.xyz), seen, uv);
}

@fragment
fn receive(surface: Placed) -> @location(0) f32 {
    return shade(light_at(surface.place), surface.normal);
}

@fragment
fn receive_cut(surface: PlacedCut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return shade(light_at(surface.place), surface.normal);
}
