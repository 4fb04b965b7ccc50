//! The casters of a view: everything whose shadow can fall into its map, however near to the light.

use arrayvec::ArrayVec;
use glam::DVec3;

use crate::frame::CullVolume;
use crate::warp::window::Window;

/// The prism along the light over a window, ending at `far` and open towards the light. What lies at or behind the
/// centre of projection of a warped map (W ≤ 0) is outside: opposite sides add up to a positive multiple of W.
pub(crate) fn prism(window: &Window, far: f64, origin: DVec3) -> CullVolume {
    let light = &window.light;
    let mut planes = ArrayVec::new();
    for side in window.sides() {
        planes.push((light.p() * side.x + light.q() * side.y).extend(side.w));
    }
    planes.push((-light.travel()).extend(far));
    CullVolume { origin, planes }
}

/// Moves the end of a prism along the light.
pub(crate) fn end_at(prism: &mut CullVolume, far: f64) {
    if let Some(end) = prism.planes.last_mut() {
        end.w = far;
    }
}
