// Least share of any distribution with four moments `b` that lies before `z`, given the roots: shadow, 0 to 1.
fn antumbra_moments_least(b: vec4f, z: f32, roots: vec2f) -> f32 {
    if (!(z > roots.x)) {
        return 0.0;
    }
    // Up to the greater root only the lesser one is before z; behind it everything but what is at z.
    let between = z <= roots.y;
    let other = select(roots.x, roots.y, between);
    let weight = (other * select(roots.y, z, between) - b.x * (other + select(roots.y, z, between)) + b.y)
        / antumbra_moments_divisor((z - roots.x) * select(z - roots.y, roots.y - roots.x, between));
    let share = select(1.0 - weight, weight, between);
    return select(0.0, min(share, 1.0), share > 0.0);
}
