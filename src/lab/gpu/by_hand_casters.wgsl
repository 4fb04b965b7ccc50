// The yardstick for casters: a matrix and nothing else.
@group(0) @binding(0) var<uniform> light: mat4x4f;

struct Cut {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn throw_solid(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return light * vec4f(position, 1.0);
}

@vertex
fn throw_cut(@location(0) position: vec3f, @location(2) uv: vec2f) -> Cut {
    return Cut(light * vec4f(position, 1.0), uv);
}

@fragment
fn cut(surface: Cut) {
    if is_hole(surface.uv) {
        discard;
    }
}
