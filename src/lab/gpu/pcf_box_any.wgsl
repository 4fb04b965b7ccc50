// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = f32(BOX_TAPS);
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// A box of any odd width, as an engine writes it: a loop over bilinear taps, each between two texels of an axis, with the
// weights (1 - f, 1, ..., 1, f) that the library's boxes have.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    let f = fract(look.uv * vec2f(textureDimensions(map)) - 0.5);
    var sum = 0.0;
    for (var row = 0; row < BOX_TAPS; row++) {
        let y = box_tap(row, f.y);
        for (var column = 0; column < BOX_TAPS; column++) {
            let x = box_tap(column, f.x);
            sum += antumbra_tap(map, compare, look, vec2f(x.x, y.x)) * (x.y * y.y);
        }
    }
    let width = f32(2 * BOX_TAPS - 1);
    return sum / (width * width);
}

// Offset of a tap from the receiver, texels, and its weight.
fn box_tap(index: i32, f: f32) -> vec2f {
    let before = select(1.0, 1.0 - f, index == 0);
    let after = select(1.0, f, index == BOX_TAPS - 1);
    return vec2f(f32(2 * index + 1 - BOX_TAPS) + after / (before + after) - f, before + after);
}
