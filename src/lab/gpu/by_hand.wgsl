// The yardstick: the cheapest lookup that anybody writes by hand. One matrix, one sample, one constant bias.
@group(1) @binding(0) var<uniform> texture_from_render: mat4x4f;
@group(1) @binding(1) var map: texture_depth_2d;
@group(1) @binding(2) var compare: sampler_comparison;

const BIAS: f32 = 0.002;

fn lit(position: vec3f) -> f32 {
    let at = texture_from_render * vec4f(position, 1.0);
    return textureSampleCompareLevel(map, compare, at.xy, at.z - BIAS);
}

@fragment
fn receive(surface: Solid) -> @location(0) f32 {
    return shade(lit(surface.position), surface.normal);
}

@fragment
fn receive_cut(surface: Cut) -> @location(0) f32 {
    if is_hole(surface.uv) {
        discard;
    }
    return shade(lit(surface.position), surface.normal);
}
