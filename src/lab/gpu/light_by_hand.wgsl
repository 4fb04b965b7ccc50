// The yardstick: the cheapest lookup that anybody writes by hand. One matrix, one sample, one constant bias.
@group(1) @binding(0) var<uniform> texture_from_render: mat4x4f;
@group(1) @binding(1) var map: texture_depth_2d;
@group(1) @binding(2) var compare: sampler_comparison;

const BIAS: f32 = 0.002;

fn place_light(position: vec3f, normal: vec3f) -> vec3f {
    let at = texture_from_render * vec4f(position, 1.0);
    return vec3f(at.xy, at.z - BIAS);
}

fn light_at(place: vec3f) -> f32 {
    return textureSampleCompareLevel(map, compare, place.xy, place.z);
}

fn light(position: vec3f, normal: vec3f) -> f32 {
    return light_at(place_light(position, normal));
}
