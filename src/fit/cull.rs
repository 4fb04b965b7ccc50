//! The casters of a view: everything whose shadow can fall into its map, however near to the light.

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3};

use crate::frame::CullVolume;
use crate::light_space::LightSpace;

/// The prism along the light over the rectangle `[low, high]`, ending at `far` and open towards the light.
pub(crate) fn prism(light: &LightSpace, low: DVec2, high: DVec2, far: f64, origin: DVec3) -> CullVolume {
    let mut planes = ArrayVec::new();
    planes.push(light.p().extend(-low.x));
    planes.push((-light.p()).extend(high.x));
    planes.push(light.q().extend(-low.y));
    planes.push((-light.q()).extend(high.y));
    planes.push((-light.travel()).extend(far));
    CullVolume { origin, planes }
}
