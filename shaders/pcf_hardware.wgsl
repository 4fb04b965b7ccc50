// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 1.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// The four nearest texels, compared and then weighted by the sampler.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    return antumbra_sample(map, compare, look, look.uv, look.depth);
}
