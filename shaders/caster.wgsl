// Where a caster's vertex goes. `position` is in render space; `clip_from_render` is the view's.
fn antumbra_caster(clip_from_render: mat4x4f, position: vec3f) -> vec4f {
    return clip_from_render * vec4f(position, 1.0);
}
