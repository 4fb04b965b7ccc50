// Texels from a receiver to the farthest texel read, and the same for one tap.
const ANTUMBRA_REACH: f32 = 1.0;
const ANTUMBRA_TAP_REACH: f32 = 1.0;

// Four bilinear comparisons over the pixel's own part of the map, on a grid that is turned so that each has a row and a
// column of its own (Reeves, Salesin and Cook 1987: filter what the pixel covers). Where texels are larger than pixels
// it is one bilinear comparison.
fn antumbra_filter(map: texture_depth_2d, compare: sampler_comparison, look: AntumbraLookup) -> f32 {
    return 0.25
        * (antumbra_pixel_pair(map, compare, look, look.spread.first, look.spread.lift.x)
            + antumbra_pixel_pair(map, compare, look, look.spread.second, look.spread.lift.y));
}
