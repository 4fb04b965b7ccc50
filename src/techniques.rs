//! Techniques by name, with the paper each is from.

use crate::remix::{Remix, Warp};

/// The standard shadow map: one uniform map over the whole scene. Its map does not depend on the camera.
///
/// L. Williams, *Casting curved shadows on curved surfaces*, SIGGRAPH 1978.
#[must_use]
pub fn ssm() -> Remix {
    Remix { warp: Warp::Uniform, ..Remix::default() }
}

/// The focused shadow map: one uniform map over what is in view.
///
/// S. Brabec, T. Annen, H.-P. Seidel, *Practical shadow mapping*, Journal of Graphics Tools 7(4), 2002.
#[must_use]
pub fn fsm() -> Remix {
    Remix { warp: Warp::Focused, ..Remix::default() }
}

/// Makes a remix with its default options.
pub type Maker = fn() -> Remix;

/// Every named technique, in the order in which reports list them.
pub const NAMED: &[(&str, Maker)] = &[("ssm", ssm), ("fsm", fsm)];

/// The technique of that name, if there is one.
#[must_use]
pub fn by_name(name: &str) -> Option<Remix> {
    NAMED.iter().find(|(known, _)| *known == name).map(|(_, technique)| technique())
}
