// Share of the light at a depth, 0 to 1, by four moments: a bound from above (Hamburger).
fn antumbra_moments_lit(moments: vec4f, depth: f32, bias: f32) -> f32 {
    let b = antumbra_moments_sound(moments, bias);
    let z = 2.0 * depth - 1.0;
    return 1.0 - antumbra_moments_least(b, z, antumbra_moments_roots(b, z));
}
