// Two moments in the numbers that sixteen bits keep, each 0 to 1.
fn antumbra_variance_packed(moments: vec2f) -> vec2f {
    return vec2f(moments.x + 0.5, 4.0 * moments.y);
}

// And back.
fn antumbra_variance_unpacked(stored: vec2f) -> vec2f {
    return vec2f(stored.x - 0.5, 0.25 * stored.y);
}
