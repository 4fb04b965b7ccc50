//! Warps as their papers want them: what a fit without guard emits, measured through the emitted matrix.

mod common;

use antumbra::warp::perspective::post_perspective_light;
use antumbra::{
    Aabb, Camera, FitInput, Focus, Light, MapBudget, Part, Remix, Scene, ShadowFrame, ShadowTechnique, Warp, Why,
};
use common::tally::Tally;
use glam::{DMat4, DVec2, DVec3, DVec4};
use proptest::prelude::*;

/// Texels of a map, of the border that the default filter wants on each side, and of the ring that is never drawn.
const SIDE: u32 = 1024;
const BORDER: u32 = 5;
const RING: u32 = 1;

/// A square view from the origin along −z over open ground, so that what is in view is the whole frustum.
#[derive(Clone, Copy, Debug)]
struct View {
    near: f64,
    far: f64,
    tangent: f64,
    travel: DVec3,
}

impl View {
    fn camera(&self) -> Camera {
        let mut camera = Camera::perspective(DMat4::IDENTITY, 2.0 * self.tangent.atan(), 1.0, self.near, self.far);
        camera.viewport = glam::UVec2::splat(1000);
        camera
    }

    fn fit(&self, warp: Warp, guard: bool) -> ShadowFrame {
        let reach = 10.0 * self.far * (1.0 + self.tangent);
        let input = FitInput {
            camera: self.camera(),
            light: Light::Directional { travel: self.travel },
            scene: Scene::within(Aabb::new(DVec3::splat(-reach), DVec3::splat(reach))),
            map: MapBudget::one(SIDE),
            origin: DVec3::ZERO,
            previous: None,
        };
        let frame = Remix { warp, guard, ..Remix::default() }.fit(&input).unwrap();
        assert_eq!(frame.views.len(), 1, "{:?}", frame.left_out);
        frame
    }

    fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|bits| {
            let depth = if bits & 4 == 0 { self.near } else { self.far };
            let [x, y] = [1, 2].map(|bit| if bits & bit == 0 { -self.tangent } else { self.tangent });
            DVec3::new(x, y, -1.0) * depth
        })
    }

    /// The view direction across the light, unit length.
    fn axis(&self) -> DVec3 {
        (DVec3::NEG_Z - self.travel * self.travel.dot(DVec3::NEG_Z)).normalize_or(self.travel.any_orthonormal_vector())
    }

    /// Light this far off the view (radians), turned about it.
    fn lit(near: f64, far: f64, tangent: f64, gamma: f64, turn: f64) -> Self {
        let aside = DVec3::new(turn.cos(), turn.sin(), 0.0);
        Self { near, far, tangent, travel: (DVec3::NEG_Z * gamma.cos() + aside * gamma.sin()).normalize() }
    }
}

/// What a warped map does to a plane across the light, read off its matrix.
struct Emitted {
    clip_from_world: DMat4,
    /// Unit axis of the warp across the light, near to far, and the one across it.
    axis: DVec3,
    side: DVec3,
}

impl Emitted {
    fn of(frame: &ShadowFrame, view: &View) -> Self {
        let clip_from_world = frame.views[0].clip_from_render.as_dmat4();
        let gradient = clip_from_world.row(3).truncate();
        let warped = frame.views[0].warp_strength > 1e-3;
        let axis = if warped { gradient.normalize() } else { view.axis() };
        Self { clip_from_world, axis, side: axis.cross(view.travel).normalize() }
    }

    fn w(&self, at: DVec3) -> f64 {
        self.clip_from_world.row(3).dot(at.extend(1.0))
    }

    /// Where a position is on the part of the map that the border surrounds, [−1, 1].
    fn map(&self, at: DVec3) -> DVec2 {
        let clip = self.clip_from_world * at.extend(1.0);
        let drawn = f64::from(SIDE - 2 * RING) / f64::from(SIDE - 2 * BORDER);
        DVec2::new(clip.x, clip.y) / clip.w * drawn
    }

    /// Change of the map along a direction, per world unit, by central differences.
    fn change(&self, at: DVec3, along: DVec3, step: f64) -> DVec2 {
        (self.map(at + along * step) - self.map(at - along * step)) / (2.0 * step)
    }

    /// The map's coordinate along the axis as the papers count it: 1 on the top line (near), −1 on the base line.
    fn paper_y(&self, at: DVec3) -> f64 {
        let change = self.change(at, self.axis, 1e-4);
        let (map, down) =
            if change.x.abs() > change.y.abs() { (self.map(at).x, change.x) } else { (self.map(at).y, change.y) };
        -map * down.signum()
    }
}

/// `M_t` and `M_s` of `MATH.md` section 2 for one texel over the map: 1/(∂Y/∂u) and 1/(∂X/∂c) over eye depth, largest
/// over the corners of the view, by differentiating the emitted matrix.
/// Y is the map's coordinate that does not change across the axis.
fn worst_footprint(frame: &ShadowFrame, view: &View) -> [f64; 2] {
    let emitted = Emitted::of(frame, view);
    let mut worst = [0.0_f64; 2];
    for corner in view.corners() {
        // Small against the distance to the centre of projection, large against rounding.
        let gradient = emitted.clip_from_world.row(3).truncate().length();
        let step = 1e-6 * (-corner.z / view.tangent.max(1.0)).min(emitted.w(corner) / gradient.max(1e-9));
        let [along, across] =
            [emitted.axis, emitted.side].map(|direction| emitted.change(corner, direction, step).abs());
        // Across the axis only X changes.
        let (y, x) = if across.x < across.y { (along.x, across.y) } else { (along.y, across.x) };
        for (worst, per_map) in worst.iter_mut().zip([y, x]) {
            *worst = worst.max(2.0 / per_map / -corner.z);
        }
    }
    worst
}

/// The same for a warp along the view, whose strength alone is known: in the fitted form of `MATH.md` section 0, with
/// side lines through the eye's image.
fn worst_fitted(view: &View, strength: f64) -> f64 {
    let (axis, side) = (view.axis(), view.axis().cross(view.travel).normalize());
    let points = view.corners().map(|at| (at.dot(axis), at.dot(side), -at.z));
    let top = points.iter().map(|(u, ..)| *u).fold(f64::INFINITY, f64::min);
    let extent = points.iter().map(|(u, ..)| *u).fold(f64::NEG_INFINITY, f64::max) - top;
    let w = |u: f64| 1.0 + strength * (u - top) / extent;
    let aside = points.map(|(u, c, _)| c / w(u));
    let width =
        aside.iter().copied().fold(f64::NEG_INFINITY, f64::max) - aside.iter().copied().fold(f64::INFINITY, f64::min);
    let texel = |(u, _, depth): (f64, f64, f64)| (width * w(u)).max(extent / (1.0 + strength) * w(u) * w(u)) / depth;
    points.into_iter().map(texel).fold(0.0, f64::max)
}

/// Cases of a property that its condition let pass.
static REACHED: Tally<4> = Tally::new();

/// The conditions of the properties below let most cases pass.
#[test]
fn properties_reach_what_they_are_about() {
    the_focus_is_on_the_80_percent_line();
    psm_is_the_view_of_the_light_in_post_perspective_space();
    minimax_has_the_least_worst_footprint();
    let reached = REACHED.read();
    println!(
        "80 % line {}, PSM {}, minimax {}, of which against PSM {}",
        reached[0], reached[1], reached[2], reached[3]
    );
    assert!(reached.iter().all(|count| *count >= 5_000), "{reached:?}");
}

fn limited(frame: &ShadowFrame) -> bool {
    frame
        .left_out
        .iter()
        .any(|cut| matches!(cut, antumbra::LeftOut { part: Part::Warp(_), why: Why::WarpTooStrong { .. } }))
}

fn views() -> impl Strategy<Value = View> {
    (-1.0..1.0_f64, 0.1..3.0_f64, 5.0..160.0_f64, 0.0..std::f64::consts::PI, 0.0..std::f64::consts::TAU).prop_map(
        |(near, range, fov, gamma, turn)| {
            let near = 10_f64.powf(near);
            View::lit(near, near * 10_f64.powf(range), (0.5 * fov.to_radians()).tan(), gamma, turn)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    /// TSM: the point in focus lies on the 80 % line, y = −0.6, wherever the light is.
    fn the_focus_is_on_the_80_percent_line(view in views(), share in 0.01..0.9_f32) {
        let frame = view.fit(Warp::Trapezoidal { focus: Focus::Share(share) }, false);
        if limited(&frame) || frame.views[0].warp_strength < 1e-2 {
            return Ok(());
        }
        REACHED.count(0);
        let emitted = Emitted::of(&frame, &view);
        let focus = DVec3::NEG_Z * (view.near + f64::from(share) * (view.far - view.near));
        let y = emitted.paper_y(focus);
        prop_assert!((y + 0.6).abs() < 1e-3, "y = {y}, strength {}", frame.views[0].warp_strength);
    }

    /// LiSPSM with light across the view: W grows from near to far by the root of the ratio of eye depths.
    #[test]
    fn lispsm_balances_both_ends(view in views()) {
        let across = View { travel: DVec3::NEG_Y, ..view };
        let frame = across.fit(Warp::LightSpacePerspective, false);
        let emitted = Emitted::of(&frame, &across);
        let [near, far] = [view.near, view.far].map(|depth| emitted.w(DVec3::NEG_Z * depth));
        prop_assert!((near - 1.0).abs() < 1e-4, "W is 1 on the top line, not {near}");
        let expected = (view.far / view.near).sqrt();
        prop_assert!((far / near / expected - 1.0).abs() < 1e-4, "{} instead of {expected}", far / near);
    }

    /// PSM: W is that of a projection from the light's image in post-perspective space, up to scale.
    fn psm_is_the_view_of_the_light_in_post_perspective_space(view in views()) {
        let frame = view.fit(Warp::Perspective { pull_back: 0.0 }, false);
        if limited(&frame) {
            return Ok(());
        }
        REACHED.count(1);
        let emitted = Emitted::of(&frame, &view);
        let tangent = view.tangent;
        let light = post_perspective_light([-tangent, tangent, -tangent, tangent], view.near, view.far, -view.travel);
        let centre = DVec3::new(0.0, 0.0, 0.5);
        let from_centre = light.truncate() - light.w * centre;
        let scale = view.far / (view.far - view.near);
        let theirs = |at: DVec3| {
            let image = DVec3::new(at.x / tangent, at.y / tangent, scale * (-at.z - view.near)) / -at.z;
            // Distance from the light along its axis, over that of the centre: 1 − κ (x − g) · a.
            let along = (image - centre).dot(from_centre) / from_centre.length_squared();
            -at.z * (1.0 - light.w * along)
        };
        let corners = view.corners();
        let (ours, exact) = (corners.map(|at| emitted.w(at)), corners.map(theirs));
        let [top, their_top] = [ours, exact].map(|w| w.into_iter().fold(f64::INFINITY, f64::min));
        for (ours, exact) in ours.into_iter().zip(exact) {
            let (ours, exact) = (ours / top, exact / their_top);
            prop_assert!((ours / exact - 1.0).abs() < 1e-3, "{ours} instead of {exact}");
        }
    }

    /// Minimax: its worst footprint, max(`M_s`, `M_t`) over the corners of the view, is no larger than that of any
    /// other warp. Compared are (a) emitted matrices without guard, each along its own axis, differentiated; (b) any
    /// strength at all along the view, fitted.
    fn minimax_has_the_least_worst_footprint(
        view in views(), share in 0.0..1.0_f32, log_strength in -3.0..2.0_f64, log_back in -3.0..3.0_f64,
    ) {
        let worst = |warp| {
            let frame = view.fit(warp, false);
            let [along, across] = worst_footprint(&frame, &view);
            (along.max(across), f64::from(frame.views[0].warp_strength))
        };
        let (ours, strength) = worst(Warp::Minimax);
        REACHED.count(2);
        // What is read off the matrix is what was minimised.
        let fitted = worst_fitted(&view, strength);
        prop_assert!((ours / fitted - 1.0).abs() < 2e-3, "{ours} measured, {fitted} fitted, strength {strength}");
        let any = worst_fitted(&view, 10_f64.powf(log_strength));
        prop_assert!(fitted <= any * 1.001, "{fitted} at {strength}, {any} at 1e{log_strength}");
        for warp in [
            Warp::Fixed { strength: 0.0 },
            Warp::LightSpacePerspective,
            Warp::Trapezoidal { focus: Focus::Share(share) },
            Warp::Perspective { pull_back: 0.0 },
            Warp::Perspective { pull_back: (view.near * 10_f64.powf(log_back)) as f32 },
        ] {
            let (theirs, theirs_strength) = match warp {
                Warp::Fixed { .. } => (worst_fitted(&view, 0.0), 0.0),
                _ => worst(warp),
            };
            if matches!(warp, Warp::Perspective { .. }) {
                REACHED.count(3);
            }
            prop_assert!(ours <= theirs * 1.002, "{ours} at {strength}, {warp:?} {theirs} at {theirs_strength}");
        }
    }

    /// PSM keeps orientation and what W is whichever side of the eye plane the light is on, and exactly on it.
    #[test]
    fn psm_does_not_flip(view in views(), log in -12.0..0.0_f64) {
        for z in [10_f64.powf(log), 0.0, -10_f64.powf(log)] {
            let view = View { travel: DVec3::new(view.travel.x, view.travel.y - 1e-3, -z).normalize(), ..view };
            let frame = view.fit(Warp::Perspective { pull_back: 0.0 }, false);
            let emitted = Emitted::of(&frame, &view);
            for corner in view.corners() {
                prop_assert!(emitted.w(corner) > 0.5);
            }
            let middle = DVec3::NEG_Z * (0.5 * (view.near + view.far));
            let rows = [0, 1, 3].map(|row| emitted.clip_from_world.row(row));
            let [x, y, w]: [DVec3; 3] = rows.map(|row: DVec4| {
                DVec3::new(row.truncate().dot(emitted.axis), row.truncate().dot(emitted.axis.cross(view.travel)), row.dot(middle.extend(1.0)))
            });
            prop_assert!(x.cross(y).dot(w) > 0.0);
        }
    }
}

/// PSM with light that crosses the eye plane: the map moves by as much as the light turns,
/// with no jump where ℓ'_w changes its sign.
#[test]
fn psm_is_continuous_across_the_eye_plane() {
    let largest_step = |steps: u32, guard: bool| {
        let maps = (0..=steps).map(|step| {
            let z = 1e-3 - 2e-3 * f64::from(step) / f64::from(steps);
            let view = View { near: 1.0, far: 50.0, tangent: 0.577, travel: DVec3::new(0.3, -0.8, z).normalize() };
            let emitted = Emitted::of(&view.fit(Warp::Perspective { pull_back: 0.0 }, guard), &view);
            view.corners().map(|corner| emitted.map(corner))
        });
        let maps: Vec<_> = maps.collect();
        let moved = |pair: &[[DVec2; 8]]| (0..8).map(|i| pair[0][i].distance(pair[1][i])).fold(0.0, f64::max);
        maps.windows(2).map(moved).fold(0.0, f64::max)
    };
    for guard in [false, true] {
        let [coarse, fine] = [20, 200].map(|steps| largest_step(steps, guard));
        println!("guard {guard}: largest step {coarse:.2e} of the map at 20 steps, {fine:.2e} at 200");
        assert!(coarse < 1e-3 && fine < 0.2 * coarse, "{coarse} {fine}");
    }
    // Exactly on it.
    let on = View { near: 1.0, far: 50.0, tangent: 0.577, travel: DVec3::new(0.6, -0.8, 0.0) };
    let frame = on.fit(Warp::Perspective { pull_back: 0.0 }, false);
    assert!(frame.views[0].warp_strength > 1.0 && frame.views[0].clip_from_render.is_finite());
}
