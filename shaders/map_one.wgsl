// Where to look, and what to compare with.
struct AntumbraLookup {
    uv: vec2f,
    // Light depth of the receiver after its bias.
    depth: f32,
    // Change of that depth over one texel step in u and in v, along the receiver's plane.
    slope: vec2f,
}

// The four texels around `uv`, compared with `depth` and then weighted by the sampler.
fn antumbra_sample(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup, uv: vec2f, depth: f32) -> f32 {
    return textureSampleCompareLevel(map, compare, uv, min(depth, 1.0));
}
