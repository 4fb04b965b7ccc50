//! Minimax: the strength with the least *worst* footprint.
//!
//! ```text
//! (1)  M_t(κ) = max W² / ((1/λ + κ) ζ)        a texel along the axis, in pixels
//! (2)  M_s(κ) = max (a1 − a0) W / ζ           a texel across it
//! ```
//!
//! Both maxima are at vertices of the body exactly: W²/ζ is convex and W/ζ quasi-linear along every line. One number bounds the whole
//! picture; what it does to the mean of the picture is another matter (`docs/WARPS.md`).
//!
//! # References
//! - `MATH.md` section 2, the table and its algorithm; section 10 row 25.
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008: storage and worst error.

use super::search::least;
use super::sight::{Choice, Sight};
use crate::math::homography::WarpFrame;

/// The strength of least worst footprint, at most κλ = `limit`.
pub(crate) fn choose(sight: &Sight, limit: f64) -> Choice {
    let frame = sight.frame();
    let strength = least(limit, |strength| worst(sight, &frame, strength));
    Choice { frame, strength }
}

/// max(`M_s`, `M_t`) at κλ = `strength`: the longest side of a texel over eye depth, for one texel over the map.
pub(crate) fn worst(sight: &Sight, frame: &WarpFrame, strength: f64) -> f64 {
    let kappa = strength / frame.extent;
    let [a0, a1] = frame.sides(kappa, &sight.points);
    let along = frame.extent / (1.0 + strength);
    let mut worst = 0.0_f64;
    for (point, size) in sight.points.iter().zip(&sight.pixel_sizes) {
        let w = 1.0 + kappa * frame.coordinates(*point).x.max(0.0);
        worst = worst.max(w * (a1 - a0).max(along * w) / size);
    }
    worst
}
