// The yardstick for casters: a matrix and nothing else.
fn clip_of(position: vec3f) -> vec4f {
    return clip_from_render * vec4f(position, 1.0);
}
