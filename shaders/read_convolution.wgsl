// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 1.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// One sample for each two terms of what was averaged before: they lie in layers, one after the other. Nothing is nearer
// than depth 0, whatever is stored there: maps that were never drawn are lit.
fn antumbra_filter(map: texture_2d_array<f32>, linear: sampler, look: AntumbraLookup) -> f32 {
    var of_terms = look;
    var sum = 0.5;
    for (var term = 0u; term < ANTUMBRA_TERMS; term += 2u) {
        of_terms.layer = (look.layer * ANTUMBRA_TERMS + term) / 2u;
        let terms = antumbra_stored_at(map, linear, of_terms) * 2.0 - 1.0;
        sum += antumbra_convolution_part(terms, clamp(look.depth, 0.0, 1.0), term);
    }
    return select(antumbra_darkened(antumbra_convolution_lit(sum), look.dark), 1.0, look.depth < 0.0);
}
