@group(2) @binding(0) var<uniform> cutoff: vec4f;
@group(2) @binding(1) var mask: texture_2d<f32>;
@group(2) @binding(2) var mask_sampler: sampler;

fn is_hole(uv: vec2f) -> bool {
    return textureSampleLevel(mask, mask_sampler, uv, 0.0).x < cutoff.x;
}
