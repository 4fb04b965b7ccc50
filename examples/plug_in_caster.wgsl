// The engine's caster stage: its own vertices, the library's matrix. No fragment shader.
@group(0) @binding(0) var<uniform> clip_from_render: mat4x4f;

@vertex
fn cast_shadow(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return antumbra_caster(clip_from_render, position);
}
