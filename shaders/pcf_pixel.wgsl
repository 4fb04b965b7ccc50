// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 1.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// One bilinear comparison of a point of the receiver's plane that is a step away: of u, v (times w), w, and depth; and
// lifted towards the light. Where
// the map does not reach as far it is one of the receiver itself.
fn antumbra_pixel_tap(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup, step: vec4f, lift: f32) -> f32 {
    let w = look.spread.w + step.z;
    let uv = (look.uv * look.spread.w + step.xy) / w;
    let depth = (look.depth / antumbra_law(look.spread.w) + step.w - lift) * antumbra_law(w);
    let held = w > 0.5 * look.spread.w && all(uv >= look.spread.low) && all(uv <= look.spread.high);
    return antumbra_sample(map, compare, look, select(look.uv, uv, held), select(look.depth, depth, held));
}

// Four bilinear comparisons over the pixel's own part of the map, on a grid that is turned so that each has a row and a
// column of its own (Reeves, Salesin and Cook 1987: filter what the pixel covers). Where texels are larger than pixels
// it is one bilinear comparison.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    let first = look.spread.first;
    let second = look.spread.second;
    let lift = look.spread.lift;
    return 0.25
        * (antumbra_pixel_tap(map, compare, look, first, lift.x) + antumbra_pixel_tap(map, compare, look, -first, lift.x)
            + antumbra_pixel_tap(map, compare, look, second, lift.y) + antumbra_pixel_tap(map, compare, look, -second, lift.y));
}
