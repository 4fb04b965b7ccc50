// Four moments from the numbers that sixteen bits keep best.
fn antumbra_moments_unpacked(stored: vec4f) -> vec4f {
    let odd = stored.xy - 0.5;
    return vec4f(
        -0.33333333 * odd.x + 1.7320508 * odd.y,
        0.125 * stored.z + stored.w,
        -0.75 * odd.x + 1.2990381 * odd.y,
        -0.125 * stored.z + stored.w,
    );
}
