// The library's lookup in two stages: `place_light` once for each vertex, `light_at` once for each fragment. For the
// filters that take one sample, which need no slope.
fn place_light(position: vec3f, normal: vec3f) -> vec3f {
    let look = antumbra_place(position, towards_viewer(position, normal));
    return vec3f(look.uv, look.depth);
}

fn light_at(place: vec3f) -> f32 {
    return antumbra_lit(AntumbraLookup(place.xy, place.z, vec2f()));
}
