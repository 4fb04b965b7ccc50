// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 0.5;
const ANTUMBRA_TAP_REACH: f32 = 0.5;

// The texel that holds the point: at its centre a bilinear comparison is the comparison with it alone.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    let size = vec2f(textureDimensions(map));
    let centre = (floor(look.uv * size) + 0.5) / size;
    return antumbra_sample(map, compare, look, centre, look.depth);
}
