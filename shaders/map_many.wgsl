// Where to look, and what to compare with.
struct AntumbraLookup {
    uv: vec2f,
    // Light depth of the receiver after its bias.
    depth: f32,
    // Change of that depth over one texel step in u and in v, along the receiver's plane.
    slope: vec2f,
    // Which layer, and the centres of the outermost texels of the map there: least and greatest u and v.
    layer: u32,
    low: vec2f,
    high: vec2f,
}

// The four texels around `uv`, compared with `depth` and then weighted by the sampler. What lies beyond the map are the
// texels at its rim, as if there were no other map beside it.
fn antumbra_sample(map: texture_depth_2d_array, compare: sampler_comparison, look: AntumbraLookup, uv: vec2f, depth: f32) -> f32 {
    return textureSampleCompareLevel(map, compare, clamp(uv, look.low, look.high), look.layer, min(depth, 1.0));
}
