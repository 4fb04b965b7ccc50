// The engine's own shader. `antumbra_caster`, `antumbra_place` and `antumbra_lit` come from the library's text in front
// of it.
struct Engine {
    clip_from_world: mat4x4f,
    // The direction to the sun.
    to_sun: vec4f,
}
@group(0) @binding(0) var<uniform> engine: Engine;

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) normal: vec3f,
    @location(1) colour: vec3f,
    // Where the map is looked up, and the depth that is compared there. (Box filters want the slope as well.)
    @location(2) shadow: vec3f,
}

@vertex
fn place(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) colour: vec3f) -> Surface {
    // Meshes here have flat faces or small ones, and are closed: their normals are on the side that is looked at.
    // Smooth normals on large triangles would take `antumbra_visibility` in the fragment stage instead.
    let look = antumbra_place(position, normal);
    return Surface(engine.clip_from_world * vec4f(position, 1.0), normal, colour, vec3f(look.uv, look.depth));
}

@fragment
fn shade(in: Surface) -> @location(0) vec4f {
    let visible = antumbra_lit(AntumbraLookup(in.shadow.xy, in.shadow.z, vec2f()));
    // Sun, and a sky that is brighter above.
    let normal = normalize(in.normal);
    let sun = vec3f(0.80, 0.74, 0.62) * max(dot(normal, engine.to_sun.xyz), 0.0) * visible;
    let sky = vec3f(0.24, 0.29, 0.37) * (0.6 + 0.4 * normal.y);
    return vec4f(in.colour * (sun + sky), 1.0);
}
