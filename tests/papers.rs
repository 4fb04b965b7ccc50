//! Numbers that the papers print, or that follow from their formulas: recomputed, printed beside them, and compared.

use antumbra::lab::depth_error::{Layout, crossing};
use antumbra::warp::homography::{
    Homography, LINE_80_PERCENT, LINE_HALF, LINE_TWO_THIRDS, WarpFrame, kappa_for_line, n_opt, n_opt_directional,
    n_opt_eye_range, n_opt_simple,
};
use antumbra::warp::perspective::post_perspective_light;
use glam::{DVec2, DVec3};

/// Prints a value beside its reference and holds it to `tolerance`, relative.
fn close(what: &str, value: f64, reference: f64, tolerance: f64) {
    let error = ((value - reference) / reference).abs();
    println!("{what:<44} {value:<24} {reference:<24} {error:.1e}");
    assert!(error <= tolerance, "{what}: {value} instead of {reference}");
}

/// Holds a value to the digits that are printed.
fn printed(what: &str, value: f64, reference: f64, digits: i32) {
    let error = (value - reference).abs();
    println!("{what:<44} {value:<24} {reference:<24} {error:.1e}");
    assert!(error <= 0.5 * 10_f64.powi(-digits) * (1.0 + 1e-9), "{what}: {value} instead of {reference}");
}

/// A handful of roundings.
const ROUNDING: f64 = 4e-15;

// Trapezoidal shadow maps.

/// η = λ d' (1 + ξ) / (λ − 2 d' − λ ξ).
#[test]
fn centre_of_projection_of_the_80_percent_rule() {
    let eta = |extent, focus, line| 1.0 / kappa_for_line(extent, focus, line);
    close("eta(2, 0.5, -0.6) = 2/11", eta(2.0, 0.5, LINE_80_PERCENT), 2.0 / 11.0, ROUNDING);
    close("kappa(2, 0.5, -0.6)", kappa_for_line(2.0, 0.5, LINE_80_PERCENT), 5.5, ROUNDING);
    close("eta(1, 0.1, -0.6)", eta(1.0, 0.1, LINE_80_PERCENT), 0.028_571_428_571_428_57, ROUNDING);
    close("eta(2, 0.5, 0)", eta(2.0, 0.5, LINE_HALF), 1.0, ROUNDING);
    // As the thesis prints it, ξ = 1.6 puts q on the wrong side: η < 0 for every d' > 0 (TH-1).
    for focus in [0.01, 0.5, 1.5] {
        let as_printed = 2.0 * focus * 2.6 / (2.0 - 2.0 * focus - 2.0 * 1.6);
        assert!(as_printed < 0.0);
    }
}

#[test]
fn warp_by_hand() {
    let frame = WarpFrame { top: DVec2::ZERO, axis: DVec2::X, extent: 2.0 };
    let warp = Homography::between(&frame, 5.5, [-0.1, 0.2]);
    for (point, x, y, w) in [
        (DVec2::new(0.5, 0.05), -0.244_444_444_444_444_44, -0.6, 3.75),
        (DVec2::new(1.0, 0.3), -0.025_641_025_641_025_64, -0.846_153_846_153_846_1, 6.5),
    ] {
        let at = warp.map(point);
        close("X/W", at.x, x, 10.0 * ROUNDING);
        close("Y/W", at.y, y, ROUNDING);
        close("W", warp.homogeneous(point).z, w, ROUNDING);
    }
}

/// One warp, two names: strengths of different papers that are the same homography.
#[test]
fn papers_that_agree() {
    close(
        "n = 11 is d' = 28.2857...",
        1.0 / kappa_for_line(99.0, 28.285_714_285_714_286, LINE_80_PERCENT),
        11.0,
        ROUNDING,
    );
    // Filament's least n, d / (2 − 3 d/λ), puts two thirds of the map before the focus.
    for focus in [0.5, 3.0, 40.0, 60.0] {
        let filament: f64 = focus / (2.0 - 3.0 * focus / 99.0);
        close("Filament's nopt1", 1.0 / kappa_for_line(99.0, focus, LINE_TWO_THIRDS), filament, ROUNDING);
    }
    // Camera-space shadow maps give the first half of the map to what is before F.
    close("push-back for the first half", kappa_for_line(99.0, 9.0, LINE_HALF), 1.0 / 11.0, ROUNDING);
}

// Light-space perspective shadow maps.

#[test]
fn optimal_n() {
    let sine = 45_f64.to_radians().sin();
    close("n_opt(1, 99, 90 deg)", n_opt_directional(1.0, 99.0, 1.0), 11.0, ROUNDING);
    close("n_opt(0.1, 69.9, 90 deg)", n_opt_directional(0.1, 69.9, 1.0), 2.745_751_311_064_59, ROUNDING);
    close("n_opt(1, 100, 45 deg)", n_opt_directional(1.0, 100.0, sine), 13.390_079_135_988_62, ROUNDING);
    close("  from the depths at both ends", n_opt(100.0, 1.0, 1.0 + 100.0 * sine), 13.390_079_135_988_62, ROUNDING);
    close(
        "n_opt(1, 100, 30 deg)",
        n_opt_directional(1.0, 100.0, 30_f64.to_radians().sin()),
        16.282_856_857_085_7,
        ROUNDING,
    );
}

/// What published code makes of one formula, for near 1, far 100, light 45 degrees off the view, d = 70.0 (99 sin 45°).
#[test]
fn published_variants_of_n() {
    let sine = 45_f64.to_radians().sin();
    let range = 99.0 * sine;
    printed("paper", n_opt_directional(1.0, range, sine), 11.464, 3);
    printed("eq. (1) with a light-space range (SC-1)", n_opt_eye_range(1.0, range, sine), 13.331, 3);
    printed("eq. (1) with an eye-space range", n_opt_eye_range(1.0, 99.0, sine), 15.556, 3);
    printed("demo of 2004", n_opt_eye_range(1.0 / sine, range * sine, sine), 14.000, 3);
    printed("demo of 2006, older function", n_opt_eye_range(1.0, 99.0 * sine, sine), 13.331, 3);
    printed("Ogre's default", n_opt_simple(1.0, 100.0), 1.1, 12);
}

/// Corners of a frustum (60°, square) as light at `gamma` off the view sees them, with their eye depths.
fn frustum(near: f64, far: f64, gamma: f64) -> [(DVec2, f64); 8] {
    let tangent = 30_f64.to_radians().tan();
    // The axis is the view direction across the light; the view is tilted in the plane of the axis.
    let (sine, cosine) = (gamma.sin(), gamma.cos());
    std::array::from_fn(|corner| {
        let depth = if corner & 4 == 0 { near } else { far };
        let [x, y] = [1, 2].map(|bit| if corner & bit == 0 { -depth * tangent } else { depth * tangent });
        (DVec2::new(depth * sine + y * cosine, x), depth)
    })
}

/// Largest texel spacing over eye depth, across (`M_s`) and along (`M_t`) the axis: exact at the corners.
fn worst_spacing(corners: &[(DVec2, f64); 8], frame: &WarpFrame, kappa: f64) -> [f64; 2] {
    let hull = corners.map(|(point, _)| point);
    let [a0, a1] = frame.sides(kappa, &hull);
    let mut worst = [0.0_f64; 2];
    for (point, depth) in corners {
        let w = 1.0 + kappa * frame.coordinates(*point).x;
        worst[0] = worst[0].max((a1 - a0) * w / depth);
        worst[1] = worst[1].max(w * w / ((1.0 / frame.extent + kappa) * depth));
    }
    worst
}

/// κ with the least worst spacing (golden section over ln κ, against none), and that spacing.
fn minimax(corners: &[(DVec2, f64); 8], frame: &WarpFrame) -> (f64, f64) {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let worst = |kappa: f64| worst_spacing(corners, frame, kappa).into_iter().fold(0.0, f64::max);
    let (mut low, mut high) = ((1e-6 / frame.extent).ln(), (1e3 / frame.extent).ln());
    for _ in 0..80 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if worst(a.exp()) < worst(b.exp()) { high = b } else { low = a }
    }
    let best = low.midpoint(high).exp();
    if worst(best) < worst(0.0) { (best, worst(best)) } else { (0.0, worst(0.0)) }
}

/// Angle, near to far; published n with its two spacings; minimax n (none: uniform) with its one;
/// digits after the point.
type Tilted = (f64, f64, [f64; 3], Option<f64>, f64, [i32; 5]);

/// Tilted light: the published n is worse than uniform where light is less than half the field of view off the view.
#[rustfmt::skip]
const TILTED: [Tilted; 14] = [
    (90.0, 1e2, [11.00, 11.55, 9.90], Some(10.10), 10.69, [2, 2, 2, 2, 2]),
    (60.0, 1e2, [12.73, 21.99, 12.52], Some(8.72), 16.29, [2, 2, 2, 2, 2]),
    (45.0, 1e2, [14.04, 39.31, 13.96], Some(5.94), 21.95, [2, 2, 2, 2, 2]),
    (35.0, 1e2, [15.36, 74.35, 15.1], Some(3.13), 36.0, [2, 2, 1, 2, 1]),
    (30.0, 1e2, [16.3, 122.6, 15.8], None, 115.5, [1, 1, 1, 0, 1]),
    (20.0, 1e2, [21.0, 230.7, 70.2], None, 115.5, [1, 1, 1, 0, 1]),
    (10.0, 1e2, [32.0, 260.7, 127.3], None, 115.5, [1, 1, 1, 0, 1]),
    (90.0, 1e3, [32.6, 36.5, 31.6], Some(30.27), 33.96, [1, 1, 1, 2, 2]),
    (60.0, 1e3, [37.7, 71.9, 37.6], Some(26.39), 51.6, [1, 1, 1, 2, 1]),
    (45.0, 1e3, [41.15, 142.65, 41.3], Some(18.22), 69.4, [2, 2, 1, 2, 1]),
    (35.0, 1e3, [44.5, 361.8, 44.5], Some(9.82), 112.6, [1, 1, 1, 2, 1]),
    (30.0, 1e3, [46.8, 1179.0, 46.6], None, 1155.0, [1, 0, 1, 0, 0]),
    (20.0, 1e3, [59.3, 5075.0, 1086.0], None, 1155.0, [1, 0, 0, 0, 0]),
    (10.0, 1e3, [86.9, 6413.0, 2490.0], None, 1155.0, [1, 0, 0, 0, 0]),
];

#[test]
fn tilted_light() {
    for (degrees, far, [n, across, along], best, least, digits) in TILTED {
        let gamma: f64 = f64::to_radians(degrees);
        let corners = frustum(1.0, far, gamma);
        let frame = WarpFrame::around(DVec2::X, DVec2::ZERO, &corners.map(|(point, _)| point));
        let published = n_opt_directional(1.0, frame.extent, gamma.sin());
        let spacing = worst_spacing(&corners, &frame, frame.limited(1.0 / published));
        println!("far/near {far}, {degrees} degrees");
        printed("  published n", published, n, digits[0]);
        printed("  spacing across", spacing[0], across, digits[1]);
        printed("  spacing along", spacing[1], along, digits[2]);
        let (kappa, worst) = minimax(&corners, &frame);
        printed("  least worst spacing", worst, least, digits[4]);
        match best {
            Some(n) => printed("  its n", 1.0 / kappa, n, digits[3]),
            None => assert_eq!(kappa, 0.0, "uniform is best at {degrees} degrees"),
        }
    }
}

/// Perspective shadow maps: where directional light goes in post-perspective space (60°, square, 1 to 50), in front of
/// the viewer and behind; it lies on the plane z = f/(f − n).
#[test]
fn light_in_post_perspective_space() {
    let tangent = 30_f64.to_radians().tan();
    for (towards_z, sign) in [(-0.5, 1.0), (0.5, -1.0)] {
        let towards = DVec3::new(0.3, 0.8, towards_z);
        let light = post_perspective_light([-tangent, tangent, -tangent, tangent], 1.0, 50.0, towards);
        assert_eq!(light.w, 0.5 * sign);
        let at = light.truncate() / light.w;
        close("x of the light", at.x, 1.039_230_484_541_326_4 * sign, ROUNDING);
        close("y of the light", at.y, 2.771_281_292_110_203_7 * sign, ROUNDING);
        close("z of the light", at.z, 1.020_408_163_265_306_1, ROUNDING);
    }
    let across = post_perspective_light([-tangent, tangent, -tangent, tangent], 1.0, 50.0, DVec3::new(0.6, 0.8, 0.0));
    assert_eq!((across.z, across.w), (0.0, 0.0), "parallel light stays parallel");
}

// Error of a map over depth, Chong's and Lloyd's metric in one dimension.

const DEPTHS: [f64; 2] = [1.0, 100.0];

#[test]
fn error_over_depth() {
    let layouts = [
        Layout::Uniform,
        Layout::Logarithmic,
        Layout::Projection { pull_back: 0.0 },
        Layout::Projection { pull_back: 10.0 },
    ];
    for (z, expected, digits) in [
        (1.0, [99.0, 4.60517, 0.99, 9.9], [5, 5, 5, 5]),
        (2.0, [49.5, 4.60517, 1.98, 5.89091], [5, 5, 5, 5]),
        (5.0, [19.8, 4.60517, 4.95, 3.68182], [5, 5, 5, 5]),
        (10.0, [9.9, 4.60517, 9.9, 3.27273], [5, 5, 5, 5]),
        (24.785_05, [3.99434, 4.60517, 24.5372, 3.99434], [5, 5, 4, 5]),
        (50.0, [1.98, 4.60517, 49.5, 5.89091], [5, 5, 5, 5]),
        (100.0, [0.99, 4.60517, 99.0, 9.9], [5, 5, 5, 5]),
    ] {
        for index in 0..layouts.len() {
            printed(
                &format!("E({z}), layout {index}"),
                layouts[index].error(DEPTHS, z),
                expected[index],
                digits[index],
            );
        }
    }
    close("ln 100", Layout::Logarithmic.error(DEPTHS, 3.0), 4.605_170_185_988_091, ROUNDING);
    close("least of o = 10", layouts[3].error(DEPTHS, 10.0), 3.272_727_272_727_272_7, ROUNDING);
    // Nothing is gained in sum: ∫ dz / (z E(z)) = 1 for every layout (midpoint rule over ln z).
    for layout in layouts {
        let steps = 20_000;
        let width = DEPTHS[1].ln() / f64::from(steps);
        let depths = (0..steps).map(|step| ((f64::from(step) + 0.5) * width).exp());
        let sum: f64 = depths.map(|z| width / layout.error(DEPTHS, z)).sum();
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }
}

#[test]
fn crossings_of_the_errors() {
    let [uniform, log, none, ten] = [
        Layout::Uniform,
        Layout::Logarithmic,
        Layout::Projection { pull_back: 0.0 },
        Layout::Projection { pull_back: 10.0 },
    ];
    let at = |a, b, between| crossing(a, b, DEPTHS, between).expect("the layouts cross");
    close("uniform and o = 0", at(uniform, none, [1.0, 100.0]), 10.0, ROUNDING);
    close("uniform and o = 10", at(uniform, ten, [1.0, 100.0]), 24.785_054_261_852_173, ROUNDING);
    printed("logarithmic and uniform", at(log, uniform, [1.0, 100.0]), 21.49758, 5);
    printed("logarithmic and o = 10, near", at(log, ten, [1.0, 10.0]), 3.00475, 5);
    printed("logarithmic and o = 10, far", at(log, ten, [10.0, 100.0]), 33.28067, 5);
    assert_eq!(crossing(uniform, log, DEPTHS, [1.0, 20.0]), None, "uniform is worse all the way");
}

/// Texels that an overhead light needs, S = `M_s` `M_t`, for a projection whose near plane is n' from its centre.
fn storage([n, f]: [f64; 2], n_prime: f64) -> f64 {
    let f_prime = n_prime + (f - n);
    let across = (f * n_prime / (f_prime * n)).max(1.0);
    let along = ((f - n) * n_prime / (f_prime * n)).max((f - n) * f_prime / (n_prime * f));
    across * along
}

#[test]
fn storage_factors() {
    let range = [1.0, 1000.0];
    // Uniform is the projection from infinitely far: f (f − n) / n².
    close("uniform, 1000", storage(range, 1e15), 999_000.0, 1e-10);
    // Perspective needs (f − n)/n for every n' from n to n + √(n f): a constant range.
    for n_prime in [1.0, 11.0, 1.0 + 1000_f64.sqrt()] {
        close("perspective, 1000", storage(range, n_prime), 999.0, 1e-12);
    }
    close("logarithmic, 1000", Layout::Logarithmic.error(range, 1.0), 6.907_755_278_982_137, ROUNDING);
    for (n_prime, expected) in [(1.0, 99.0), (11.0, 99.0)] {
        close("perspective, 100", storage(DEPTHS, n_prime), expected, 1e-12);
    }
    printed("perspective beyond its range, 100", storage(DEPTHS, 22.0), 327.3, 1);
    // k logarithmic splits, each uniform or warped.
    for (k, uniform, warped, digits) in
        [(1.0, 999_000.0, 999.0, 6), (2.0, 1936.8, 61.25, 1), (3.0, 270.0, 27.0, 9), (4.0, 104.0, 18.494, 1)]
    {
        let ratio = 1000_f64.powf(1.0 / k);
        printed("splits, uniform", k * ratio * (ratio - 1.0), uniform, digits);
        printed("splits, warped", k * (ratio - 1.0), warped, digits);
    }
    printed("four warped splits", 4.0 * (1000_f64.powf(0.25) - 1.0), 18.494, 3);
}
