// Visibility where the rule for grazing light is for the whole.
const ANTUMBRA_GRAZED: f32 = 0.5;

// Where the light grazes a surface, half of it arrives, and maps are not asked.
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    let grazed = antumbra_grazing(normal, antumbra_uniforms.view.depth_from_render);
    if (grazed >= 1.0) {
        return ANTUMBRA_GRAZED;
    }
    return mix(antumbra_mapped(position, normal, view_depth), ANTUMBRA_GRAZED, grazed);
}
