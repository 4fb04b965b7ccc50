// Where to look, and at which depth.
struct AntumbraLookup {
    uv: vec2f,
    // Light depth of the receiver after its bias.
    depth: f32,
    // Change of that depth over one texel step in u and in v, along the receiver's plane.
    slope: vec2f,
    // The centres of the outermost texels of the map: least and greatest u and v.
    low: vec2f,
    high: vec2f,
    // Half-widths in texels of the box that is averaged, and light that is taken for bleeding.
    radius: vec2f,
    dark: f32,
}
