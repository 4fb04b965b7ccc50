//! The trapezoid: the published chain of eight matrices and the closed form are one map,
//! and it does what the paper wants.

use antumbra::warp::homography::{LINE_80_PERCENT, WarpFrame};
use antumbra::warp::trapezoid::{Trapezoid, chain};
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

/// SplitMix64: random numbers that are the same everywhere.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Every power of ten alike.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn point(&mut self, size: f64) -> DVec2 {
        DVec2::new(self.between(-size, size), self.between(-size, size))
    }
}

/// What a light may see of a frustum: eight points, near ones about one centre and far ones about another,
/// and the point in focus.
struct Seen {
    centres: [DVec2; 2],
    hull: [DVec2; 8],
    focus: DVec2,
}

/// `degenerate`: slivers as thin as 1e-6 of their length, far off the origin, with nearly parallel sides.
fn seen(random: &mut Random, degenerate: bool) -> Seen {
    let (thin, away, parallel, closest) = if degenerate { (1e-6, 1e3, 1e-6, 0.004) } else { (0.1, 1.0, 0.02, 0.02) };
    let axis = DVec2::from_angle(random.between(0.0, std::f64::consts::TAU));
    let near = random.point(away);
    let far = near + axis * random.scale(0.3, 3.0);
    let [near_width, far_width] = [(); 2].map(|()| random.scale(thin, 1.0));
    let across = axis.perp();
    let hull = std::array::from_fn(|index| {
        let (centre, width) = if index < 4 { (near, near_width) } else { (far, far_width) };
        let side = if index % 2 == 0 { -1.0 } else { 1.0 };
        centre + across * (side * width * random.between(0.5, 1.0)) + axis * random.between(-0.1, 0.1)
    });
    // d' from κλ = 195 (or its limit of 1000, at 0.8/201) to nearly 0.8 λ.
    let frame = WarpFrame::around(axis, near, &hull);
    let share = if random.unit() < 0.5 { random.scale(closest, 0.4) } else { 0.8 - random.scale(parallel, 0.4) };
    Seen { centres: [near, far], hull, focus: frame.point(share * frame.extent, 0.0) }
}

/// A chain without its depth: rows x, y, w over columns x, y, and the point's constant.
fn plane(map_from_light: DMat4) -> DMat3 {
    // The third coordinate is 1 and stays: rows x, y and w do not read it.
    for row in [0, 1, 3] {
        assert_eq!(map_from_light.row(row).z, 0.0);
    }
    let rows = [0, 1, 3].map(|row| map_from_light.row(row));
    DMat3::from_cols_array_2d(&rows.map(|row| [row.x, row.y, row.w])).transpose()
}

/// Largest difference of two homographies after giving both W = 1 at `top`: each row against the size of its terms
/// `reach` away from the origin of coordinates.
fn difference(map_from_a: DMat3, map_from_b: DMat3, top: DVec2, reach: f64) -> f64 {
    let scaled = |map_from_plane: DMat3| {
        let unit = map_from_plane * (1.0 / (map_from_plane * top.extend(1.0)).z);
        unit * DMat3::from_diagonal(DVec3::new(reach, reach, 1.0))
    };
    let (a, b) = (scaled(map_from_a), scaled(map_from_b));
    (0..3).map(|row| (a.row(row) - b.row(row)).length() / b.row(row).length()).fold(0.0, f64::max)
}

/// Largest distance of a corner from the origin of coordinates.
fn reach(corners: &[DVec2; 4]) -> f64 {
    corners.iter().map(|corner| corner.length()).fold(0.0, f64::max)
}

/// What rounding costs: coordinates as large as the reach are subtracted to give the top line, λ, and W = 1 on the top
/// line, and q is as uncertain as the sides are parallel.
fn condition(trapezoid: &Trapezoid) -> f64 {
    let corners = trapezoid.corners();
    let least = corners[2].distance(corners[3]).min(trapezoid.frame.extent);
    let strength = trapezoid.kappa * trapezoid.frame.extent;
    (1.0 + reach(&corners) * (1.0 / least + trapezoid.kappa)) * (1.0 + 1.0 / strength)
}

const SQUARE: [DVec2; 4] = [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0)];

/// Largest errors of one trapezoid.
#[derive(Default, Debug)]
struct Errors {
    /// Chain against closed form, the same with mirrored corners.
    chain: f64,
    mirrored: f64,
    /// Corners against the square's, by the chain and by the closed form.
    chain_corners: f64,
    corners: f64,
    /// y of the point in focus against −0.6.
    focus: f64,
    /// How far a point of the hull is off the map.
    outside: f64,
}

fn errors(seen: &Seen, trapezoid: &Trapezoid) -> Errors {
    let closed = trapezoid.map_from_light();
    let corners = trapezoid.corners();
    let top = trapezoid.frame.top;
    // The chain, and the chain of the corners named the other way round.
    let chained = plane(chain::map_from_light(corners).expect("sides that meet"));
    let [t0, t1, t2, t3] = corners;
    let mirrored = plane(chain::map_from_light([t1, t0, t3, t2]).expect("sides that meet"));
    let w_at_top = |map_from_plane: DMat3| (map_from_plane * top.extend(1.0)).z;
    // The sense of rotation is the sign of the determinant where W > 0.
    assert!(closed.determinant() > 0.0);
    assert!((chained * (1.0 / w_at_top(chained))).determinant() > 0.0);
    assert!((mirrored * (1.0 / w_at_top(mirrored))).determinant() < 0.0);
    let turned = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)) * mirrored;
    let through = |map_from_plane: DMat3, point: DVec2| {
        let at = map_from_plane * point.extend(1.0);
        at.truncate() / at.z
    };
    let farthest = |from: &dyn Fn(DVec2) -> DVec2| {
        corners.iter().zip(SQUARE).map(|(corner, goal)| from(*corner).distance(goal)).fold(0.0, f64::max)
    };
    let excess = |point: &DVec2| closed.map(*point).abs().max_element() - 1.0;
    Errors {
        chain: difference(chained, closed.map_from_plane(), top, reach(&corners)),
        mirrored: difference(turned, closed.map_from_plane(), top, reach(&corners)),
        chain_corners: farthest(&|corner| through(chained, corner)),
        corners: farthest(&|corner| closed.map(corner)),
        focus: (closed.map(seen.focus).y - LINE_80_PERCENT).abs(),
        outside: seen.hull.iter().map(excess).fold(0.0, f64::max),
    }
}

impl Errors {
    /// Keeps the larger of each.
    fn widen(&mut self, other: &Self, scale: f64) {
        self.chain = self.chain.max(other.chain * scale);
        self.mirrored = self.mirrored.max(other.mirrored * scale);
        self.chain_corners = self.chain_corners.max(other.chain_corners * scale);
        self.corners = self.corners.max(other.corners * scale);
        self.focus = self.focus.max(other.focus * scale);
        self.outside = self.outside.max(other.outside * scale);
    }

    fn largest(&self) -> f64 {
        let Self { chain, mirrored, chain_corners, corners, focus, outside } = *self;
        [chain, mirrored, chain_corners, corners, focus, outside].into_iter().fold(0.0, f64::max)
    }
}

/// Both ways from corners to a map agree to 1e-12, and do what they are for, on 100,000 trapezoids with a condition of
/// up to 1e4 (nine in ten at least); beyond that, as far as their corners are known.
#[test]
fn chain_and_closed_form_are_one() {
    let mut random = Random(2004);
    let (mut worst, mut beyond) = (Errors::default(), Errors::default());
    let mut tame = 0;
    for _ in 0..100_000 {
        let seen = seen(&mut random, false);
        let trapezoid = Trapezoid::around(seen.centres, &seen.hull, seen.focus, LINE_80_PERCENT);
        let (condition, errors) = (condition(&trapezoid), errors(&seen, &trapezoid));
        if condition <= 1e4 {
            tame += 1;
            worst.widen(&errors, 1.0);
        } else {
            beyond.widen(&errors, 1.0 / condition);
        }
    }
    println!("{tame} of 100000: {worst:?}; over condition {beyond:?}");
    assert!(tame >= 90_000, "{tame}");
    assert!(worst.largest() <= 1e-12, "{worst:?}");
    assert!(beyond.largest() <= 16.0 * f64::EPSILON, "{beyond:?}");
}

/// Nearly degenerate ones agree as far as their corners are known: 16 roundings times the condition.
#[test]
fn nearly_degenerate_trapezoids() {
    let mut random = Random(2008);
    let mut worst = Errors::default();
    let mut hardest = 0.0_f64;
    for _ in 0..100_000 {
        let seen = seen(&mut random, true);
        let trapezoid = Trapezoid::around(seen.centres, &seen.hull, seen.focus, LINE_80_PERCENT);
        let condition = condition(&trapezoid);
        hardest = hardest.max(condition);
        worst.widen(&errors(&seen, &trapezoid), 1.0 / condition);
    }
    println!("condition up to {hardest:.1e}; over condition {worst:?}");
    assert!(hardest > 1e12, "the generator reaches what it is about");
    assert!(worst.largest() <= 16.0 * f64::EPSILON, "{worst:?}");
}

/// Each matrix of the chain does what its picture says.
#[test]
fn chain_in_pictures() {
    let frame = WarpFrame { top: DVec2::new(1.0, 2.0), axis: DVec2::new(0.6, 0.8), extent: 2.0 };
    let trapezoid = Trapezoid { frame, focus: 0.5, kappa: 5.5, sides: [-0.1, 0.2] };
    let mut at = trapezoid.corners().map(chain::homogeneous);
    let step = |to_from: DMat4, at: &mut [DVec4; 4]| {
        *at = at.map(|corner| to_from * corner);
        at.map(|corner| DVec2::new(corner.x, corner.y) / corner.w)
    };
    let near = |a: DVec2, b: DVec2| assert!(a.distance(b) < 1e-12, "{a} instead of {b}");
    // T1: the middle of the top line is in the origin.
    let [.., t2, t3] = step(chain::top_from_light(at), &mut at);
    near(t2, -t3);
    // R: the top line lies along x, the base line above it.
    let [t0, t1, t2, t3] = step(chain::upright_from_top(at), &mut at);
    near(t2 - t3, DVec2::new(0.3, 0.0));
    assert!((t0.y - 2.0).abs() < 1e-12 && (t1.y - 2.0).abs() < 1e-12);
    // T2: the sides meet in the origin.
    let [t0, t1, t2, t3] = step(chain::apex_from_upright(at).expect("sides that meet"), &mut at);
    near(t0, 12.0 * t3);
    near(t1, 12.0 * t2);
    // H: symmetric about y.
    let [.., t2, t3] = step(chain::isosceles_from_apex(at), &mut at);
    near(t2, DVec2::new(-t3.x, t3.y));
    // S1: sides are x = ±y, the top line is y = 1.
    let [t0, t1, t2, t3] = step(chain::unit_from_isosceles(at), &mut at);
    near(t2, DVec2::new(1.0, 1.0));
    near(t3, DVec2::new(-1.0, 1.0));
    near(t0, DVec2::new(-12.0, 12.0));
    near(t1, DVec2::new(12.0, 12.0));
    // N: a rectangle with its top at y = 2.
    let [t0, t1, t2, t3] = step(chain::rectangle_from_unit(), &mut at);
    near(t2, DVec2::new(1.0, 2.0));
    near(t3, DVec2::new(-1.0, 2.0));
    near(t0, DVec2::new(-1.0, 1.0 + 1.0 / 12.0));
    near(t1, DVec2::new(1.0, 1.0 + 1.0 / 12.0));
    // T3: its middle is in the origin.
    let [t0, _, t2, _] = step(chain::middle_from_rectangle(at), &mut at);
    near(t0, -t2);
    // S2: the square.
    for (corner, goal) in step(chain::map_from_middle(at), &mut at).into_iter().zip(SQUARE) {
        near(corner, goal);
    }
}

/// TH-3 and TH-4: what the printed N does, and where depth goes.
#[test]
fn printed_chain_is_wrong_where_the_errata_say() {
    let frame = WarpFrame { top: DVec2::new(1.0, 2.0), axis: DVec2::new(0.6, 0.8), extent: 2.0 };
    let trapezoid = Trapezoid { frame, focus: 0.5, kappa: 5.5, sides: [-0.1, 0.2] };
    let corners = trapezoid.corners();
    let map_from_light = chain::map_from_light(corners).expect("sides that meet");
    let z_over_w = |corner: DVec2| {
        let at = map_from_light * chain::homogeneous(corner);
        at.z / at.w
    };
    // z/w is 1 on the top line and 1/k on the base line.
    for (corner, expected) in corners.into_iter().zip([1.0 / 12.0, 1.0 / 12.0, 1.0, 1.0]) {
        assert!((z_over_w(corner) / z_over_w(corners[2]) - expected).abs() < 1e-12);
    }
    // As printed, N repeats its second row as its fourth.
    let mut rectangle_from_unit = chain::rectangle_from_unit().transpose();
    assert_ne!(rectangle_from_unit.determinant(), 0.0);
    rectangle_from_unit.w_axis = DVec4::new(0.0, 1.0, 0.0, 1.0);
    assert_eq!(rectangle_from_unit.determinant(), 0.0);
    // Parallel sides have no chain, and a closed form.
    let parallel = Trapezoid { kappa: 0.0, ..trapezoid };
    assert_eq!(chain::map_from_light([(-1.0, -2.0), (1.0, -2.0), (1.0, 1.0), (-1.0, 1.0)].map(DVec2::from)), None);
    assert_eq!(parallel.map_from_light().w, DVec3::Z);
    assert_eq!(parallel.centre_of_projection(), None);
}

/// The view along the light has no centre line: parallel sides.
#[test]
fn no_centre_line_no_warp() {
    let hull = SQUARE;
    for far in [DVec2::ZERO, DVec2::new(1e-4, 0.0), DVec2::NAN] {
        let trapezoid = Trapezoid::around([DVec2::ZERO, far], &hull, DVec2::ZERO, LINE_80_PERCENT);
        assert_eq!(trapezoid.kappa, 0.0);
        let map = trapezoid.map_from_light();
        assert!(hull.iter().all(|corner| map.map(*corner).abs().max_element() <= 1.0 + 1e-12));
    }
}
