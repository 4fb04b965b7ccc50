// The library's answer among several maps, over an array of cases. The library's text comes before.
struct Case {
    // Position, and the eye depth.
    position: vec4f,
    // Normal, and the noise that turns a disc.
    normal: vec4f,
}

@group(0) @binding(0) var<storage, read> cases: array<Case>;
@group(0) @binding(1) var<storage, read_write> found: array<f32>;

@compute @workgroup_size(64)
fn run(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&cases) {
        return;
    }
    let case_ = cases[id.x];
    found[id.x] = visibility(case_.position.xyz, case_.normal.xyz, case_.position.w, case_.normal.w);
}
