// A texel may outgrow what lies within reach by half; maps that are warped more than that are not made.
const ANTUMBRA_MOST_GROWTH: f32 = 0.5;

// Below every fall there is; keeps a receiver without one from dividing by zero.
const ANTUMBRA_SMALLEST: f32 = 1e-37;

// Texels along an axis that a receiver moves by for each texel of reach, at most: (a + b) a / (a a + b b).
const ANTUMBRA_MOST_SHIFT: f32 = 1.2072;

// As antumbra_lookup, for a warped map: positions are divided by w, and the size of a texel is that at the receiver
// (bias.rs derives it). Where a surface grazes the light, the receiver moves across the light alone, by texels, which
// no warp magnifies.
// reach: texels from the receiver to the farthest texel read; tap_reach: the same for one tap of the filter.
fn antumbra_lookup_projective(view: AntumbraView, position: vec3f, normal: vec3f, reach: f32, tap_reach: f32) -> AntumbraLookup {
    let at = vec4f(position + normal * view.bias.y, 1.0);
    let w = dot(view.w_from_render, at);
    // What lies behind the centre of projection is outside of the map, and lit.
    let inside = w > 0.0;
    let from_w = select(0.0, 1.0 / w, inside);
    let uv = vec2f(dot(view.u_from_render, at), dot(view.v_from_render, at)) * from_w;
    // How far the receiver's plane falls over a texel, measured along its normal.
    let shared_fall = dot(view.across_w.xyz, normal);
    let fall = w * w * vec2f(dot(view.across_v.xyz, normal) - uv.y * shared_fall, uv.x * shared_fall - dot(view.across_u.xyz, normal));
    let step = abs(fall.x) + abs(fall.y);
    // Cosines are in depth per world unit. What is not lifted along the light moves up the fall instead.
    let cosine = -dot(view.depth_from_render.xyz, normal);
    let inverse = 1.0 / max(abs(cosine), view.texel.w);
    let across = 1.0 - abs(cosine) * inverse;
    let wide = reach + view.bias.x;
    let up = fall / max(max(abs(fall.x), abs(fall.y)), ANTUMBRA_SMALLEST);
    let shift = up * (wide * across * (abs(up.x) + abs(up.y)) / max(dot(up, up), 1.0));
    // By what share of itself the fall grows or shrinks on the way to the farthest texel.
    let growth = min(wide * (1.0 + across * ANTUMBRA_MOST_SHIFT) * view.bias.z * abs(w), ANTUMBRA_MOST_GROWTH);
    // The side that is turned away is pushed off the light instead: a sheet shades its own back.
    let depth_per_fall = select(-view.texel.z, view.texel.z, cosine >= 0.0) * inverse;
    // Taps know the receiver's plane as it is here; growth makes it steeper there.
    let lift = (tap_reach + view.bias.x + reach * growth) / (1.0 - growth) * step * depth_per_fall;
    var look: AntumbraLookup;
    look.uv = uv + shift * view.bias.w;
    // Texels within reach have a w that is greater by no more than growth: they hold no less than this.
    let law = antumbra_law(select(1.0, w / (1.0 - growth), inside));
    look.depth = select(-1.0, (dot(view.depth_from_render, at) - lift) * law, inside);
    look.slope = fall * depth_per_fall * law;
    return look;
}
