// Hosts that carry nothing but what finds the light: what goes from vertices to fragments, and the fragments.
// `light_of(at)` is the host's.
struct Lean {
    @builtin(position) @invariant clip: vec4f,
    @location(0) at: vec3f,
}

struct LeanCut {
    @builtin(position) @invariant clip: vec4f,
    @location(0) at: vec3f,
    @location(1) uv: vec2f,
}

@fragment
fn receive(surface: Lean) -> @location(0) f32 {
    return light_of(surface.at);
}

@fragment
fn receive_cut(surface: LeanCut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return light_of(surface.at);
}
