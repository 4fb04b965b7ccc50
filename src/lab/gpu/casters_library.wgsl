fn clip_of(position: vec3f) -> vec4f {
    return antumbra_caster(clip_from_render, position);
}
