// Two moments from the numbers that integers keep best.
fn antumbra_variance_unpacked(stored: vec2f) -> vec2f {
    return vec2f(stored.x - 0.5, 0.25 * stored.y);
}
