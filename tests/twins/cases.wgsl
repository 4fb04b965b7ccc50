// Every numeric function of the library, over an array of cases. The library's text comes before, the calls that only
// some keys have come after.
struct Case {
    view: AntumbraView,
    position: vec4f,
    normal: vec4f,
    // uv, depth, and the noise that turns a disc.
    look: vec4f,
    // Slope, and the offset of a tap.
    slope_offset: vec4f,
    // A row of a box: three x, one y.
    row: vec4f,
    weight: vec4f,
}

struct Outcome {
    uv: vec2f,
    depth: f32,
    visible: f32,
    slope: vec2f,
    filtered: f32,
    visibility: f32,
    clip: vec4f,
    tap: f32,
    row: f32,
    // The lookup in two stages, where there is one.
    lit: f32,
    // Of a caster's vertex, for warped maps.
    caster_depth: f32,
}

@group(0) @binding(0) var<storage, read> cases: array<Case>;
@group(0) @binding(1) var<storage, read_write> outcomes: array<Outcome>;

@compute @workgroup_size(64)
fn run(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&cases) {
        return;
    }
    let case_ = cases[id.x];
    let view = case_.view;
    let found = lookup(view, case_.position.xyz, case_.normal.xyz);
    let given = given(case_);
    var out: Outcome;
    out.uv = found.uv;
    out.depth = found.depth;
    out.slope = found.slope;
    out.filtered = antumbra_filter(antumbra_map, antumbra_compare, given);
    out.visible = visible(view, case_.position.xyz, case_.normal.xyz, case_.look.w);
    out.visibility = visibility(case_.position.xyz, case_.normal.xyz, case_.look.w);
    out.lit = lit(case_.position.xyz, case_.normal.xyz);
    out.caster_depth = antumbra_caster_depth(view.depth_from_render, case_.position.xyz);
    let matrix = mat4x4f(view.u_from_render, view.v_from_render, view.w_from_render, view.depth_from_render);
    out.clip = antumbra_caster(matrix, case_.position.xyz);
    out.tap = tap(given, case_.slope_offset.zw);
    out.row = row(given, case_.row.xyz, case_.weight.xyz, case_.row.w);
    outcomes[id.x] = out;
}
