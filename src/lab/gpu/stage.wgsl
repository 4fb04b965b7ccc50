// The laboratory's camera passes. Group 0 is the camera, group 1 the shadow maps, group 2 a cut-out.
struct Camera {
    clip_from_render: mat4x4f,
    // The eye with w = 1, or the direction to the viewer with w = 0.
    eye: vec4f,
    // A row: eye depth of a position.
    view_depth: vec4f,
}
@group(0) @binding(0) var<uniform> camera: Camera;

// What goes from vertices to fragments. `at` is a position, or the place of the light where that is found at vertices.
struct Solid {
    @builtin(position) @invariant clip: vec4f,
    @location(0) at: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
}

struct Cut {
    @builtin(position) @invariant clip: vec4f,
    @location(0) at: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
    @location(2) uv: vec2f,
}

// The normal of a face, turned to the side that is looked at: the same for all of its vertices.
fn towards_viewer(position: vec3f, normal: vec3f) -> vec3f {
    let to_viewer = camera.eye.xyz - position * camera.eye.w;
    return select(normal, -normal, dot(to_viewer, normal) < 0.0);
}

@vertex
fn place_depth(@location(0) position: vec3f) -> @builtin(position) @invariant vec4f {
    return camera.clip_from_render * vec4f(position, 1.0);
}

@vertex
fn place(@location(0) position: vec3f, @location(1) normal: vec4f) -> Solid {
    return Solid(camera.clip_from_render * vec4f(position, 1.0), position, towards_viewer(position, normal.xyz));
}

@vertex
fn place_cut(@location(0) position: vec3f, @location(1) normal: vec4f, @location(2) uv: vec2f) -> Cut {
    return Cut(camera.clip_from_render * vec4f(position, 1.0), position, towards_viewer(position, normal.xyz), uv);
}

@fragment
fn cut_depth(surface: Cut) {
    if is_hole(surface.uv) {
        discard;
    }
}
