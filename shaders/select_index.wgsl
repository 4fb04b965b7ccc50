// The first map whose depths hold the receiver; views that are not in use end nowhere, and read lit.
fn antumbra_index(view_depth: f32) -> u32 {
    var index = 0u;
    for (var before = 0u; before + 1u < ANTUMBRA_MAPS; before++) {
        index += select(0u, 1u, view_depth > antumbra_uniforms.views[before].domain.y);
    }
    return index;
}
