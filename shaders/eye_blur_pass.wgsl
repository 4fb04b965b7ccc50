@group(0) @binding(0) var<uniform> antumbra_eye_blur: AntumbraEyeBlur;
@group(0) @binding(1) var antumbra_source: texture_2d<f32>;
@group(0) @binding(2) var antumbra_depth: texture_depth_2d;

// One triangle over everything.
@vertex
fn antumbra_everything(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The mean around a pixel along a row (1, 0) or a column (0, 1), over pixels of its surface.
fn antumbra_eye_blur_along(pixel: vec2i, axis: vec2i) -> vec4f {
    let size = vec2i(textureDimensions(antumbra_source));
    let middle = antumbra_eye_depth(antumbra_eye_blur, textureLoad(antumbra_depth, pixel, 0));
    let deviation = dot(antumbra_eye_blur_deviation(antumbra_eye_blur, middle), vec2f(axis));
    let reach = antumbra_eye_blur_reach(deviation);
    // The pixel itself weighs one, whatever it shows.
    var sum = textureLoad(antumbra_source, pixel, 0);
    var whole = 1.0;
    for (var step = 1; step <= reach; step++) {
        for (var side = -1; side <= 1; side += 2) {
            let other = pixel + axis * (step * side);
            if (any(other < vec2i()) || any(other >= size)) {
                continue;
            }
            let apart = antumbra_eye_depth(antumbra_eye_blur, textureLoad(antumbra_depth, other, 0)) - middle;
            let weight = antumbra_eye_blur_weight(antumbra_eye_blur, f32(step), deviation, apart);
            sum += weight * textureLoad(antumbra_source, other, 0);
            whole += weight;
        }
    }
    return sum / whole;
}

@fragment
fn antumbra_eye_blur_along_row(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return antumbra_eye_blur_along(vec2i(at.xy), vec2i(1, 0));
}

@fragment
fn antumbra_eye_blur_along_column(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return antumbra_eye_blur_along(vec2i(at.xy), vec2i(0, 1));
}
