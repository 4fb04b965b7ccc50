// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 4.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// Taps, and the radius of their disc in texels. Fewer taps show grains, more cost as much as boxes; a smaller disc is a
// box, a larger one has holes between its taps.
const ANTUMBRA_DISC_TAPS: u32 = 12u;
const ANTUMBRA_DISC_RADIUS: f32 = 3.0;

// Taps all over a disc that is turned from pixel to pixel: what would be bands becomes noise.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    var direction = antumbra_turned(look.spread.noise);
    var lit = 0.0;
    for (var point = 0u; point < ANTUMBRA_DISC_TAPS; point++) {
        let offset = direction * (ANTUMBRA_DISC_RADIUS * antumbra_out(point, ANTUMBRA_DISC_TAPS));
        lit += antumbra_tap(map, compare, look, offset);
        direction = antumbra_next(direction);
    }
    return lit / f32(ANTUMBRA_DISC_TAPS);
}
