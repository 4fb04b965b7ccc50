// The yardstick: the cheapest lookup that anybody writes by hand. One matrix, one sample, one constant bias.
//
// The bias is along the normal, as engines have it, so that the normal is used: otherwise the driver would take it out of
// the vertex stage, and the race would compare vertex stages.
@group(1) @binding(0) var<uniform> texture_from_render: mat4x4f;
@group(1) @binding(1) var map: texture_depth_2d;
@group(1) @binding(2) var compare: sampler_comparison;

const BIAS: f32 = 0.01;

fn lit(position: vec3f, normal: vec3f) -> f32 {
    let at = texture_from_render * vec4f(position + normal * BIAS, 1.0);
    return textureSampleCompareLevel(map, compare, at.xy, at.z);
}

@fragment
fn receive(surface: Solid) -> @location(0) f32 {
    return lit(surface.position, surface.normal);
}

@fragment
fn receive_cut(surface: Cut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return lit(surface.position, surface.normal);
}
