//! Techniques by name, with the paper each is from.

use crate::frame::Select;
use crate::remix::Remix;
use crate::split::{DepthSplits, Scheme, Split};
use crate::warp::{Focus, Warp};

/// Makes a remix with its default options.
pub type Maker = fn() -> Remix;

/// A function for each technique, and the list of them all: `function "name" split, warp`, behind its documentation.
macro_rules! named {
    ($($(#[$doc:meta])+ $function:ident $name:literal $split:expr, $warp:expr;)+) => {
        $(
            $(#[$doc])+
            #[must_use]
            pub fn $function() -> Remix {
                Remix { split: $split, warp: $warp, ..Remix::default() }
            }
        )+

        /// Every named technique, in the order in which reports list them.
        pub const NAMED: &[(&str, Maker)] = &[$(($name, $function)),+];
    };
}

/// The splits of the paper.
const PSSM: DepthSplits = DepthSplits {
    maps: 3,
    scheme: Scheme::Practical { lambda: 0.5, offset: 0.0 },
    select: Select::Depth,
    enough: 0.0,
    ..DepthSplits::DEFAULT
};

named! {
    /// The standard shadow map: one uniform map over the whole scene. Its map does not depend on the camera.
    ///
    /// L. Williams, *Casting curved shadows on curved surfaces*, SIGGRAPH 1978.
    ssm "ssm" Split::One, Warp::Uniform;

    /// The focused shadow map: one uniform map over what is in view.
    ///
    /// S. Brabec, T. Annen, H.-P. Seidel, *Practical shadow mapping*, Journal of Graphics Tools 7(4), 2002.
    fsm "fsm" Split::One, Warp::Focused;

    /// The perspective shadow map: the light's view of the camera's post-perspective space.
    ///
    /// M. Stamminger, G. Drettakis, *Perspective shadow maps*, SIGGRAPH 2002.
    psm "psm" Split::One, Warp::Perspective { pull_back: 0.0 };

    /// The trapezoidal shadow map: 80 % of the map for the first part of what is in view.
    ///
    /// T. Martin, T.-S. Tan, *Anti-aliasing and continuity with trapezoidal shadow maps*, EGSR 2004.
    tsm "tsm" Split::One, Warp::Trapezoidal { focus: Focus::default() };

    /// The light-space perspective shadow map: perspective errors are equal at both ends of what is in view.
    ///
    /// M. Wimmer, D. Scherzer, W. Purgathofer, *Light space perspective shadow maps*, EGSR 2004.
    lispsm "lispsm" Split::One, Warp::LightSpacePerspective;

    /// The warp with the least worst footprint.
    ///
    /// After B. Lloyd et al., *Logarithmic perspective shadow maps*, ACM Transactions on Graphics 27(4), 2008, whose
    /// bound it minimises.
    minimax "minimax" Split::One, Warp::Minimax;

    /// The warp with the least predicted picture error: this crate's own, see [`Warp::LeastError`].
    least_error "least-error" Split::One, Warp::LeastError;

    /// Parallel-split shadow maps: three maps, practical splits with λ = ½, no warp.
    ///
    /// F. Zhang, H. Sun, L. Xu, L. K. Lun, *Parallel-split shadow maps for large-scale virtual environments*, VRCIA
    /// 2006.
    pssm "pssm" Split::Depth(PSSM), Warp::Focused;

    /// Cascades: four maps where they pay most, each with the warp that pays there. This crate's own.
    cascades "cascades" Split::Depth(DepthSplits::DEFAULT), Warp::LeastError;
}

/// The technique of that name, if there is one.
#[must_use]
pub fn by_name(name: &str) -> Option<Remix> {
    NAMED.iter().find(|(known, _)| *known == name).map(|(_, technique)| technique())
}
