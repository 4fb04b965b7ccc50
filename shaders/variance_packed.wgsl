// Two moments as integers keep them best, each 0 to 1.
fn antumbra_variance_packed(moments: vec2f) -> vec2f {
    return vec2f(moments.x + 0.5, 4.0 * moments.y);
}
