// Clears a part of a layer: one triangle over all of the viewport, at the farthest depth.
@vertex
fn antumbra_clear(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(4.0 * corner - 1.0, 1.0, 1.0);
}
