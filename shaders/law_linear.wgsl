// What a depth is multiplied by before it is compared: texels hold linear depth.
fn antumbra_law(w: f32) -> f32 {
    return 1.0;
}
