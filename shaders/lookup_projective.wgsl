// Where to look, and what to compare with.
struct AntumbraLookup {
    uv: vec2f,
    // Light depth of the receiver after its bias.
    depth: f32,
    // Change of that depth over one texel step in u and in v, along the receiver's plane.
    slope: vec2f,
}

// A texel may outgrow its neighbour by half; maps that are warped more than that are not made.
const ANTUMBRA_MOST_GROWTH: f32 = 0.5;

// As antumbra_lookup, for a warped map: positions are divided by w, and the size of a texel is that at the receiver.
// reach: texels from the receiver to the farthest texel read; tap_reach: the same for one tap of the filter.
fn antumbra_lookup_projective(view: AntumbraView, position: vec3f, normal: vec3f, reach: f32, tap_reach: f32) -> AntumbraLookup {
    let at = vec4f(position, 1.0);
    let w = dot(view.w_from_render, at);
    let from_w = 1.0 / w;
    let u = dot(view.u_from_render, at) * from_w;
    let v = dot(view.v_from_render, at) * from_w;
    // How far the receiver's plane falls over a texel, measured along its normal.
    let shared_fall = dot(view.across_w.xyz, normal);
    let fall = w * w * vec2f(dot(view.across_v.xyz, normal) - v * shared_fall, u * shared_fall - dot(view.across_u.xyz, normal));
    // Over many texels it falls farther, as they grow.
    let growth = min((reach + view.bias.x) * view.bias.z * abs(w), ANTUMBRA_MOST_GROWTH);
    let step = (abs(fall.x) + abs(fall.y)) / (1.0 - growth);
    // Along the light where that is short, along the normal for the rest. Cosines are in depth per world unit.
    let cosine = -dot(view.depth_from_render.xyz, normal);
    let inverse = 1.0 / max(abs(cosine), view.texel.w);
    let along_normal = (reach + view.bias.x) * step * (1.0 - abs(cosine) * inverse) + view.bias.y;
    // The side that is turned away is pushed off the light instead: a sheet shades its own back.
    let depth_per_fall = select(-view.texel.z, view.texel.z, cosine >= 0.0) * inverse;
    let moved = vec4f(position + normal * along_normal, 1.0);
    let moved_w = dot(view.w_from_render, moved);
    var look: AntumbraLookup;
    look.uv = vec2f(dot(view.u_from_render, moved), dot(view.v_from_render, moved)) / moved_w;
    // Taps know the receiver's plane as it is here; growth makes it steeper there.
    let lift = cosine * along_normal + (tap_reach + view.bias.x + reach * growth) * step * depth_per_fall;
    // What lies behind the centre of projection is outside of the map, and lit.
    look.depth = select(-1.0, dot(view.depth_from_render, at) - lift, min(w, moved_w) > 0.0);
    look.slope = fall * depth_per_fall;
    return look;
}
