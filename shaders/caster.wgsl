// Where a caster's vertex goes. `position` is in render space; `clip_from_render` is the view's.
fn antumbra_caster(clip_from_render: mat4x4f, position: vec3f) -> vec4f {
    return clip_from_render * vec4f(position, 1.0);
}

// Linear light depth of a caster's vertex, for warped maps: interpolate it, and write it as the fragment's depth.
fn antumbra_caster_depth(depth_from_render: vec4f, position: vec3f) -> f32 {
    return dot(depth_from_render, vec4f(position, 1.0));
}
