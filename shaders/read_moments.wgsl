// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 1.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// One sample of what was averaged before. Nothing is nearer than depth 0, whatever is stored there: maps that were
// never drawn are lit.
fn antumbra_filter(map: texture_2d<f32>, linear: sampler, look: AntumbraLookup) -> f32 {
    let stored = antumbra_stored_at(map, linear, look);
    let lit = antumbra_darkened(antumbra_read(stored, clamp(look.depth, 0.0, 1.0), look.slope), look.dark);
    return select(lit, 1.0, look.depth < 0.0);
}
