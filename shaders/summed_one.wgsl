// The sum of all texels of the map before a place in it.
fn antumbra_sum_before(map: texture_2d<u32>, look: AntumbraLookup, corner: vec2i, node: vec2i) -> vec4u {
    let sum = textureLoad(map, max(corner + node - 1, vec2i(0)), 0);
    return select(vec4u(), sum, min(node.x, node.y) > 0);
}
