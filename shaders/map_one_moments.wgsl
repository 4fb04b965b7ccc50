// Where to look, and at which depth.
struct AntumbraLookup {
    uv: vec2f,
    // Light depth of the receiver after its bias.
    depth: f32,
    // Change of that depth over one texel step in u and in v, along the receiver's plane.
    slope: vec2f,
    // Light that is taken for bleeding, and the level of the mip chain.
    dark: f32,
    level: f32,
}
