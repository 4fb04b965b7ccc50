//! Minimax: the strength with the least *worst* footprint.
//!
//! ```text
//! (1)  M_t(κ) = max W² / ((1/λ + κ) ζ)        a texel along the axis, in pixels
//! (2)  M_s(κ) = max (a1 − a0) W / ζ           a texel across it
//! ```
//!
//! Both maxima are at vertices of the body exactly: W²/ζ is convex and W/ζ quasi-linear along every line. One number
//! bounds the whole picture; what it does to the mean of the picture is another matter (`docs/WARPS.md`).
//!
//! # References
//! - `MATH.md` section 2, the table and its algorithm; section 10 row 25.
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008: storage and worst
//!   error.

use super::sight::{Choice, Sight};
use crate::math::homography::WarpFrame;
use crate::math::search::least;

/// The strength of least worst footprint, at most κλ = `limit`.
pub(crate) fn choose(sight: &Sight, limit: f64) -> Choice {
    let frame = sight.frame;
    let strength = least(limit, |strength| worst(sight, &frame, strength));
    Choice { frame, strength }
}

/// max(`M_s`, `M_t`) at κλ = `strength`: the longest side of a texel over eye depth, for one texel over the map.
pub(crate) fn worst(sight: &Sight, frame: &WarpFrame, strength: f64) -> f64 {
    let kappa = strength / frame.extent;
    let [a0, a1] = frame.sides(kappa, &sight.points);
    let along = frame.extent / (1.0 + strength);
    let mut worst = 0.0_f64;
    let [constant, per_depth] = sight.pixel;
    for (point, depth) in sight.points.iter().zip(&sight.depths) {
        let w = 1.0 + kappa * frame.coordinates(*point).x.max(0.0);
        worst = worst.max(w * (a1 - a0).max(along * w) / (constant + per_depth * depth));
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::math::homography::STRONGEST;
    use glam::{DMat4, DVec3};
    use proptest::prelude::*;

    /// Vertices of a frustum, and its sight under light from `gamma` off the view.
    fn sight(camera: &Camera, travel: DVec3) -> Sight {
        let (near, far) = camera.projection.depth_range();
        let corners = camera.corners(near, far, DVec3::ZERO).map(glam::DVec4::truncate);
        Sight::of(camera, travel, &corners, DVec3::ZERO)
    }

    /// `MATH.md` section 10 row 25, section 2: 60°, square, far/near 100 and 1000; n is 1/κ, M in units of 1/ζ for one
    /// texel over the map. `None`: uniform is best.
    #[test]
    fn golden_values() {
        for (far, degrees, n, least, digits) in [
            (1e2, 90.0, Some(10.10), 10.69, 2),
            (1e2, 60.0, Some(8.72), 16.29, 2),
            (1e2, 45.0, Some(5.94), 21.95, 2),
            (1e2, 35.0, Some(3.13), 36.0, 1),
            (1e2, 30.0, None, 115.47, 2),
            (1e2, 20.0, None, 115.47, 2),
            (1e2, 10.0, None, 115.47, 2),
            (1e3, 90.0, Some(30.27), 33.96, 2),
            (1e3, 45.0, Some(18.22), 69.4, 1),
            (1e3, 30.0, None, 1155.0, 0),
        ] {
            let mut camera = Camera::perspective(DMat4::IDENTITY, 60_f64.to_radians(), 1.0, 1.0, far);
            // Pixels of the size 1 at depth 1: the larger picture side does not count twice.
            camera.viewport = glam::UVec2::splat(1);
            let (sine, cosine) = f64::to_radians(degrees).sin_cos();
            let sight = sight(&camera, DVec3::new(0.0, -sine, -cosine));
            let pixel = camera.projection.size_at(1.0).x;
            let choice = choose(&sight, STRONGEST);
            let worst = worst(&sight, &choice.frame, choice.strength) * pixel;
            let found = choice.frame.extent / choice.strength;
            println!("far/near {far:4}, {degrees:2} degrees: n {found:8.3}, M {worst:8.3}; published {n:?}, {least}");
            // The search stops within a thousandth of 1 + κλ, which is worth as much in M.
            let tolerance = 0.5 * 10_f64.powi(-digits);
            assert!((worst - least).abs() <= tolerance + 3e-4 * least, "{worst} instead of {least}");
            match n {
                Some(n) => assert!((found - n).abs() <= 0.005 + 2e-3 * n, "{found} instead of {n}"),
                None => assert_eq!(choice.strength, 0.0),
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// No strength on a fine ladder has a smaller worst footprint, whatever camera and light: there is one valley.
        #[test]
        fn least_on_a_ladder(
            fov in 1.0..170.0_f64, aspect in 0.2..4.0_f64, log_near in -2.0..1.0_f64, log_range in 0.05..6.0_f64,
            travel in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let near = 10_f64.powf(log_near);
            let camera = Camera::perspective(DMat4::IDENTITY, fov.to_radians(), aspect, near, near * 10_f64.powf(log_range));
            let Some(travel) = DVec3::from_array(travel).try_normalize() else { return Ok(()) };
            let sight = sight(&camera, travel);
            let choice = choose(&sight, STRONGEST);
            let ours = worst(&sight, &choice.frame, choice.strength);
            for step in 0..=200 {
                let strength = (f64::from(step) / 200.0 * STRONGEST.ln_1p()).exp_m1().min(STRONGEST);
                let other = worst(&sight, &choice.frame, strength);
                prop_assert!(ours <= other * 1.001, "{ours} at {}, {other} at {strength}", choice.strength);
            }
        }
    }
}
