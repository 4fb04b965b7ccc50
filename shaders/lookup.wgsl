// Lifts a receiver off its own texels (bias.rs derives it) and finds its place in an affine map.
// reach: texels from the receiver to the farthest texel read; tap_reach: the same for one tap of the filter.
fn antumbra_lookup(view: AntumbraView, position: vec3f, normal: vec3f, reach: f32, tap_reach: f32) -> AntumbraLookup {
    // How u and v change along the normal, and how far the receiver's plane falls over a texel, measured along it.
    let climb = vec2f(dot(view.u_from_render.xyz, normal), dot(view.v_from_render.xyz, normal));
    let fall = climb * view.texel.xy;
    let step = abs(fall.x) + abs(fall.y);
    // Along the light where that is short, along the normal for the rest. Cosines are in depth per world unit.
    let cosine = -dot(view.depth_from_render.xyz, normal);
    let inverse = 1.0 / max(abs(cosine), view.texel.w);
    let along_normal = (reach + view.bias.x) * step * (1.0 - abs(cosine) * inverse) + view.bias.y;
    // The side that is turned away is pushed off the light instead: a sheet shades its own back.
    let depth_per_fall = select(-view.texel.z, view.texel.z, cosine >= 0.0) * inverse;
    let at = vec4f(position, 1.0);
    var look: AntumbraLookup;
    look.uv = vec2f(dot(view.u_from_render, at), dot(view.v_from_render, at)) + climb * along_normal;
    let lift = cosine * along_normal + (tap_reach + view.bias.x) * step * depth_per_fall;
    look.depth = dot(view.depth_from_render, at) - lift;
    look.slope = fall * depth_per_fall;
    return look;
}
