// Four moments in the numbers that sixteen bits keep best, each 0 to 1: an even mixture of them.
fn antumbra_moments_packed(b: vec4f) -> vec4f {
    return vec4f(
        1.5 * b.x - 2.0 * b.z + 0.5,
        0.8660254 * b.x - 0.38490018 * b.z + 0.5,
        4.0 * (b.y - b.w),
        0.5 * (b.y + b.w),
    );
}
