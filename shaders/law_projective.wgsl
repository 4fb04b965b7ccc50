// What a depth is multiplied by before it is compared: texels hold linear depth over w.
fn antumbra_law(w: f32) -> f32 {
    return 1.0 / w;
}
