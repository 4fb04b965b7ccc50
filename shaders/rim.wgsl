// From the centres of the outermost texels of a map to those of the smaller level that is read, or of the smaller one
// of two: texture coordinates.
fn antumbra_rim(map: texture_2d_array<f32>, level: f32) -> vec2f {
    return 0.5 * f32((1u << u32(ceil(level))) - 1u) / vec2f(textureDimensions(map));
}
