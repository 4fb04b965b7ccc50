// Below every row of a light; keeps a view without one from dividing by zero.
const ANTUMBRA_GRAZING_SMALLEST: f32 = 1e-30;

// Cosine of 85 degrees.
const ANTUMBRA_GRAZING_COSINE: f32 = 0.08715574;

// The share of a receiver's visibility that is a half instead of what maps say: all of it from 85 to 90 degrees between
// the light and the normal, none elsewhere, and where there is no light or no normal.
fn antumbra_grazing(normal: vec3f, depth_from_render: vec4f) -> f32 {
    let scale = length(depth_from_render.xyz);
    let cosine = -dot(depth_from_render.xyz, normal) / max(scale, ANTUMBRA_GRAZING_SMALLEST);
    let is_known = scale > ANTUMBRA_GRAZING_SMALLEST && any(normal != vec3f());
    return select(0.0, 1.0, is_known && cosine >= 0.0 && cosine <= ANTUMBRA_GRAZING_COSINE);
}
