// A lookup with the part of the map that its pixel covers.
fn antumbra_over_pixel(view: AntumbraView, look: AntumbraLookup, position: vec3f, pixel: AntumbraPixel) -> AntumbraLookup {
    var over = look;
    over.spread = antumbra_spread(view, position, pixel);
    return over;
}
