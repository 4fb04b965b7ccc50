// Shares up to `dark` are none, the rest is stretched: takes away what shines through where shadows overlap, and the
// outer part of every penumbra with it. dark: 0 (nothing) to below 1.
fn antumbra_darkened(lit: f32, dark: f32) -> f32 {
    return clamp((lit - dark) / (1.0 - dark), 0.0, 1.0);
}
