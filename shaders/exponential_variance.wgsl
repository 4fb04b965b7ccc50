// Depth, bent twice: x grows with depth and tells near casters apart from far receivers, y grows as well but is
// negative, and does so from the other end. exponents: of both, at most half the logarithm of the largest number
// stored.
fn antumbra_warped_depth(depth: f32, exponents: vec2f) -> vec2f {
    let centred = 2.0 * depth - 1.0;
    return vec2f(exp(exponents.x * centred), -exp(-exponents.y * centred));
}
