// The engine's own shader. `antumbra_caster` and `antumbra_visibility` come from the library's text in front of it.
struct Engine {
    clip_from_world: mat4x4f,
    eye: vec4f,
    // The direction to the sun.
    to_sun: vec4f,
}
@group(0) @binding(0) var<uniform> engine: Engine;

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) colour: vec3f,
}

@vertex
fn place(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) colour: vec3f) -> Surface {
    return Surface(engine.clip_from_world * vec4f(position, 1.0), position, normal, colour);
}

@fragment
fn shade(in: Surface) -> @location(0) vec4f {
    let to_eye = engine.eye.xyz - in.position;
    // The geometric normal, on the side that is looked at: the bias depends on the true surface, not on smooth shading.
    let across = cross(dpdx(in.position), dpdy(in.position));
    let face = normalize(select(across, -across, dot(across, to_eye) < 0.0));
    let visible = antumbra_visibility(in.position, face, length(to_eye));
    // Sun, and a sky that is brighter above.
    let normal = normalize(in.normal);
    let sun = vec3f(0.80, 0.74, 0.62) * max(dot(normal, engine.to_sun.xyz), 0.0) * visible;
    let sky = vec3f(0.24, 0.29, 0.37) * (0.6 + 0.4 * normal.y);
    return vec4f(in.colour * (sun + sky), 1.0);
}
