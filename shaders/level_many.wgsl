// Level of the mip chain that a receiver is looked up in: where a texel is as large as a pixel. Texels grow with w
// along one axis of a warped map and with its square along the other.
fn antumbra_level(view: AntumbraView, position: vec3f) -> f32 {
    let at = vec4f(position, 1.0);
    let w = max(dot(view.w_from_render, at), ANTUMBRA_LEVEL_SMALLEST);
    let texels = dot(view.pixel_from_render, at) / (w * sqrt(w));
    return clamp(log2(max(texels, 1.0)), 0.0, view.moments.y);
}

// Below every w in view.
const ANTUMBRA_LEVEL_SMALLEST: f32 = 1e-6;
