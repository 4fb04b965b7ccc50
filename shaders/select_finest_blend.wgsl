// The first map that holds the receiver and what its filter reads: maps are listed from the finest on. Towards its rim
// a map gives way to the next ones that hold it, if any do.
fn antumbra_visibility(position: vec3f, normal: vec3f, view_depth: f32) -> f32 {
    var lit = 0.0;
    var rest = 1.0;
    for (var index = 0u; index < ANTUMBRA_MAPS; index++) {
        let look = antumbra_look(antumbra_uniforms.views[index], position, normal);
        let room = antumbra_room(antumbra_uniforms.views[index], look);
        if (room >= 0.0) {
            let share = rest * min(room * antumbra_uniforms.views[index].domain.w, 1.0);
            let on_map = antumbra_on_map(antumbra_uniforms.views[index], look);
            lit += share * antumbra_filter(antumbra_map, antumbra_compare, on_map);
            rest -= share;
            if (rest <= 0.0) {
                break;
            }
        }
    }
    let visibility = select(1.0, lit / (1.0 - rest), rest < 1.0);
    // At their end all maps give way to the light.
    let fade = (view_depth - antumbra_uniforms.views[0].across_v.w) * antumbra_uniforms.views[0].across_w.w;
    return mix(visibility, 1.0, clamp(fade, 0.0, 1.0));
}
