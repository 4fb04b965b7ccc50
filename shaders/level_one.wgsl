// Level of the mip chain that a receiver is looked up in: there is one.
fn antumbra_level(view: AntumbraView, position: vec3f) -> f32 {
    return 0.0;
}
