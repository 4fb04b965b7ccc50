// Most texels of a half-width: what 32 bits hold of a box of 16-bit numbers.
const ANTUMBRA_BOX_MOST: f32 = 127.0;

// Below every w in view, and below every length that is divided by.
const ANTUMBRA_BOX_SMALLEST_W: f32 = 1e-6;
const ANTUMBRA_BOX_SMALLEST: f32 = 1e-30;

// Half-widths in texels of u and v of the box that a receiver reads, whose texels have another size in the world
// everywhere in a warped map.
fn antumbra_half_widths(view: AntumbraView, position: vec3f, uv: vec2f) -> vec2f {
    let w = max(dot(view.w_from_render, vec4f(position, 1.0)), ANTUMBRA_BOX_SMALLEST_W);
    let along_u = (view.u_from_render.xyz - uv.x * view.w_from_render.xyz) / w;
    let along_v = (view.v_from_render.xyz - uv.y * view.w_from_render.xyz) / w;
    let lengths = max(vec2f(length(along_v), length(along_u)), vec2f(ANTUMBRA_BOX_SMALLEST));
    let world = view.moments.w * length(cross(along_u, along_v)) / (lengths * max(view.bias.w, ANTUMBRA_BOX_SMALLEST));
    return min(select(vec2f(-view.moments.w), world, view.moments.w >= 0.0), vec2f(ANTUMBRA_BOX_MOST));
}
