// One bilinear comparison at `offset` texels from the receiver, against the receiver's own plane there.
fn antumbra_tap(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup, offset: vec2f) -> f32 {
    let uv = look.uv + offset / vec2f(textureDimensions(map));
    return antumbra_sample(map, compare, look, uv, look.depth + dot(look.slope, offset));
}
