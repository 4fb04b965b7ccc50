// What a texel stores of a depth: four moments of it, on the range -1 to 1.
fn antumbra_moments(depth: f32) -> vec4f {
    let z = 2.0 * depth - 1.0;
    let square = z * z;
    return vec4f(z, square, square * z, square * square);
}
