// Casters of warped maps: group 0 is the view's matrix and its row of linear depth, which every fragment writes.
struct View {
    clip_from_render: mat4x4f,
    depth_from_render: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;

struct Solid {
    @builtin(position) clip: vec4f,
    @location(0) depth: f32,
}

struct Cut {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) depth: f32,
}

@vertex
fn throw_solid(@location(0) position: vec3f) -> Solid {
    return Solid(antumbra_caster(view.clip_from_render, position), antumbra_caster_depth(view.depth_from_render, position));
}

@vertex
fn throw_cut(@location(0) position: vec3f, @location(2) uv: vec2f) -> Cut {
    let clip = antumbra_caster(view.clip_from_render, position);
    return Cut(clip, uv, antumbra_caster_depth(view.depth_from_render, position));
}

@fragment
fn write_depth(surface: Solid) -> @builtin(frag_depth) f32 {
    return surface.depth;
}

@fragment
fn cut(surface: Cut) -> @builtin(frag_depth) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return surface.depth;
}
