//! How ray coordinates are laid out on a map: one homography, and the strengths that the papers choose for it.

pub use crate::math::homography;
pub(crate) mod bend;
pub(crate) mod least_error;
pub(crate) mod lispsm;
pub(crate) mod minimax;
pub mod perspective;
pub(crate) mod sheaf;
pub(crate) mod sight;
pub mod trapezoid;
pub(crate) mod window;

use crate::error::{FitError, LARGEST, within};
use crate::math::homography::STRONGEST;

/// How the light's coordinates are laid out on a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Warp {
    /// Uniform over the whole scene as the light sees it. View-independent: the map of a still scene can be kept.
    Uniform,
    /// Uniform over what is in view.
    Focused,
    /// Warped along the view by a strength given by hand: κλ, the ratio of texel densities from the near to the far
    /// side of what is in view, less one. 0 is focused; 0 to 1000. For experiments: the strength that pays differs from
    /// view to view.
    Fixed {
        /// κλ.
        strength: f32,
    },
    /// Trapezoidal: the line at the focus comes to lie at 80 % of the map (Martin & Tan 2004).
    Trapezoidal {
        /// Where the focus is.
        focus: Focus,
    },
    /// Light-space perspective with the published optimum (Wimmer, Scherzer & Purgathofer 2004).
    LightSpacePerspective,
    /// Perspective: as the light sees the camera's post-perspective space (Stamminger & Drettakis 2002).
    Perspective {
        /// How far the virtual eye stands behind the eye, world units, 0 to 1e15: more is weaker. Casters behind the
        /// eye need none, because depth is kept linear.
        pull_back: f32,
    },
    /// The strength with the least *worst* footprint over what is in view.
    Minimax,
    /// The strength, and the direction, with the least predicted picture error.
    #[default]
    LeastError,
}

/// What a trapezoidal warp is focused on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Focus {
    /// A share of the range of eye depths in view, 0 (nearest) to 1.
    Share(f32),
    /// An eye depth beyond the nearest one in view, world units, not negative.
    Distance(f32),
}

impl Default for Focus {
    /// The first third, less a little: what is within it gets 80 % of the map. Nearer starves the rest of the picture.
    fn default() -> Self {
        Self::Share(0.3)
    }
}

impl Warp {
    /// Whether maps may be projective.
    pub(crate) fn bends(self) -> bool {
        !matches!(self, Self::Uniform | Self::Focused)
    }

    /// Whether a paper gives its strength: the guard watches those.
    pub(crate) fn is_published(self) -> bool {
        matches!(
            self,
            Self::Trapezoidal { .. } | Self::LightSpacePerspective | Self::Perspective { .. } | Self::Minimax
        )
    }

    /// Checks the numbers of its options.
    pub(crate) fn validate(self) -> Result<(), FitError> {
        let (field, value, largest, legal) = match self {
            Self::Fixed { strength } => ("warp.strength", strength, STRONGEST, "0 to 1000"),
            Self::Trapezoidal { focus: Focus::Share(share) } => ("warp.focus", share, 1.0, "a share from 0 to 1"),
            Self::Trapezoidal { focus: Focus::Distance(distance) } => ("warp.focus", distance, LARGEST, "0 to 1e15"),
            Self::Perspective { pull_back } => ("warp.pull_back", pull_back, LARGEST, "0 to 1e15"),
            _ => return Ok(()),
        };
        within(field, value, [0.0, largest], legal)
    }
}
