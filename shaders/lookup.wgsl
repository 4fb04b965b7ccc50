// Where to look, and what to compare with.
struct AntumbraLookup {
    uv: vec2f,
    // Light depth of the receiver after its bias.
    depth: f32,
    // Change of that depth over one texel step in u and in v, along the receiver's plane.
    slope: vec2f,
}

// Lifts a receiver off its own texels (bias.rs derives it) and finds its place in an affine map.
// reach: texels from the receiver to the farthest texel read; tap_reach: the same for one tap of the filter.
fn antumbra_lookup(view: AntumbraView, position: vec3f, normal: vec3f, reach: f32, tap_reach: f32) -> AntumbraLookup {
    // How far the receiver's plane falls over a texel, measured along its normal.
    let fall = vec2f(dot(view.texel_u.xyz, normal), dot(view.texel_v.xyz, normal));
    let step = abs(fall.x) + abs(fall.y);
    // Along the light where that is short, along the normal for the rest.
    let cosine = -dot(view.depth_from_render.xyz, normal) * view.texel_v.w;
    let inverse = 1.0 / max(abs(cosine), view.bias.y);
    let along_normal = (reach + view.bias.z) * step * (1.0 - abs(cosine) * inverse) + view.bias.w;
    // The side that is turned away is pushed off the light instead: a sheet shades its own back.
    let depth_per_fall = select(-view.texel_u.w, view.texel_u.w, cosine >= 0.0) * inverse;
    let at = vec4f(position + normal * along_normal, 1.0);
    var look: AntumbraLookup;
    look.uv = vec2f(dot(view.u_from_render, at), dot(view.v_from_render, at));
    look.depth = dot(view.depth_from_render, at) - (tap_reach + view.bias.z) * step * depth_per_fall - view.bias.x;
    look.slope = fall * depth_per_fall;
    return look;
}
