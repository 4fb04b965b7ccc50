// How taps are spread around a receiver.
struct AntumbraSpread {
    // By how much of a whole turn the disc is turned.
    noise: f32,
}

fn antumbra_spread(view: AntumbraView, position: vec3f, noise: f32) -> AntumbraSpread {
    return AntumbraSpread(noise);
}
