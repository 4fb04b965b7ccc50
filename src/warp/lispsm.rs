//! Light-space perspective shadow maps: the strength at which perspective errors are equal at both ends of what is in
//! view.
//!
//! ```text
//! n_opt = (z_n + √(z_n (z_n + Δz))) / sin γ,   κ = 1 / n_opt,   anchored at the body's least u along V_P
//! ```
//!
//! # Where this differs from print
//! - SC-1: Δz is a range of *eye depth*, `z_f − z_n`; the text calls it the "depth extent of B in light space".
//! - SC-2: eq. (2) anchors P's near plane at the eye plus `z_n V_P`, which is the body's least u for light across the
//!   view only; here the anchor is the body's own least u, so that W ≥ 1 on it.
//! - Where γ is less than half the field of view the formula is worse than uniform: the guard's business.
//!
//! # References
//! - Wimmer, Scherzer & Purgathofer, *Light space perspective shadow maps*, 2004.
//! - Scherzer, *Robust shadow maps for large environments*, 2005: eq. (1) to (3).

use super::sight::{Choice, Sight};
use crate::math::homography::n_opt_eye_range;

/// The published warp. The far depth that is asked for (`scene.visible_depth`) shortens Δz, and nothing else.
pub(crate) fn choose(sight: &Sight) -> Choice {
    let frame = sight.frame;
    let (near, far) = sight.depth_range();
    let n = n_opt_eye_range(near, far - near, sight.view.length());
    Choice { frame, strength: frame.extent / n }
}
