// Casters: group 0 is the view's matrix. `clip_of(position)` is the library's vertex function, or one by hand.
@group(0) @binding(0) var<uniform> clip_from_render: mat4x4f;

struct Cut {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn throw_solid(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip_of(position);
}

@vertex
fn throw_cut(@location(0) position: vec3f, @location(2) uv: vec2f) -> Cut {
    return Cut(clip_of(position), uv);
}

@fragment
fn cut(surface: Cut) {
    if is_hole(surface.uv) {
        discard;
    }
}
