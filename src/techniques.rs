//! Techniques by name, with the paper each is from.

use crate::remix::Remix;
use crate::warp::{Focus, Warp};

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

/// The perspective shadow map: the light's view of the camera's post-perspective space.
///
/// M. Stamminger, G. Drettakis, *Perspective shadow maps*, SIGGRAPH 2002.
#[must_use]
pub fn psm() -> Remix {
    Remix { warp: Warp::Perspective { pull_back: 0.0 }, ..Remix::default() }
}

/// The trapezoidal shadow map: 80 % of the map for the first part of what is in view.
///
/// T. Martin, T.-S. Tan, *Anti-aliasing and continuity with trapezoidal shadow maps*, EGSR 2004.
#[must_use]
pub fn tsm() -> Remix {
    Remix { warp: Warp::Trapezoidal { focus: Focus::default() }, ..Remix::default() }
}

/// The light-space perspective shadow map: perspective errors are equal at both ends of what is in view.
///
/// M. Wimmer, D. Scherzer, W. Purgathofer, *Light space perspective shadow maps*, EGSR 2004.
#[must_use]
pub fn lispsm() -> Remix {
    Remix { warp: Warp::LightSpacePerspective, ..Remix::default() }
}

/// The warp with the least worst footprint.
///
/// After B. Lloyd et al., *Logarithmic perspective shadow maps*, ACM Transactions on Graphics 27(4), 2008, whose bound it minimises.
#[must_use]
pub fn minimax() -> Remix {
    Remix { warp: Warp::Minimax, ..Remix::default() }
}

/// The warp with the least predicted picture error: this crate's own, see [`Warp::LeastError`].
#[must_use]
pub fn least_error() -> Remix {
    Remix { warp: Warp::LeastError, ..Remix::default() }
}

/// Makes a remix with its default options.
pub type Maker = fn() -> Remix;

/// Every named technique, in the order in which reports list them.
pub const NAMED: &[(&str, Maker)] = &[
    ("ssm", ssm),
    ("fsm", fsm),
    ("psm", psm),
    ("tsm", tsm),
    ("lispsm", lispsm),
    ("minimax", minimax),
    ("least-error", least_error),
];

/// The technique of that name, if there is one.
#[must_use]
pub fn by_name(name: &str) -> Option<Remix> {
    NAMED.iter().find(|(known, _)| *known == name).map(|(_, technique)| technique())
}
