//! Where the window of a map is laid: around the body, around the whole scene, on a grid, or bent.

use glam::{DVec2, DVec3};

use crate::fit::depth_range::{rounding, rounding_margin};
use crate::fit::served::Held;
use crate::fit::share::Share;
use crate::fit::snap::{self, Stabilise};
use crate::fit::view::Fitter;
use crate::focus::FocusBody;
use crate::frame::ShadowFrame;
use crate::light_space::LightSpace;
use crate::math::homography::{STRONGEST, WarpFrame};
use crate::report::{Part, Why};
use crate::scene::Aabb;
use crate::warp::bend::{Bend, ROUNDINGS};
use crate::warp::least_error::{Predictor, Seen, uniform_error};
use crate::warp::sight::{Choice, Sight};
use crate::warp::window::Window;
use crate::warp::{Warp, lispsm, minimax, perspective, trapezoid};

/// A focused window is used when its area is at most this share of the whole scene's. At 1 every map follows the camera
/// for next to nothing; at 0.8 texels would be given away that a picture shows (a tenth of their side, about a tenth of
/// the error). At 0.9 the still map costs at most 5 % of a texel's side, and can be kept as long as the scene is still.
const WORTH_FOCUSING: f64 = 0.9;

/// Beyond the base line, a map has room for λ/(κλ) of its bent extent before the horizon: the border may take up to
/// this share of it. At 1 the outermost texels would reach infinity; near 0 only weak warps would be possible in small
/// maps.
const MOST_HORIZON: f64 = 0.5;

/// By how much W may change over what positions are uncertain by. At 1 a vertex on the top line could have W = 0; near
/// 0 warps would be given up where f32 still serves them.
const MOST_ROUNDING: f64 = 0.125;

/// The same for casters, whose texel hardly matters, but which must not come to lie behind the centre of projection: at
/// 1 they could; near 0 warps would be given up because something stands far away.
const MOST_ROUNDING_OF_CASTERS: f64 = 0.5;

/// How windows are laid.
#[derive(Clone, Copy)]
pub(crate) struct How {
    pub(crate) warp: Warp,
    /// Whether published warps are limited to what pays.
    pub(crate) guard: bool,
    pub(crate) stabilise: Stabilise,
    pub(crate) share: Share,
}

/// The window that is laid around a body.
pub(crate) struct Layout {
    /// The map's extent across the light.
    pub(crate) window: Window,
    /// κλ of its warp; 0 for uniform maps.
    pub(crate) strength: f64,
    /// Mean over what is seen of a texel's two sides, for one texel over the window, world units.
    pub(crate) error: f64,
    /// Whether it is around the whole scene, and serves every split.
    pub(crate) whole: bool,
}

impl Layout {
    fn uniform(window: Window) -> Self {
        Self { strength: 0.0, error: window.size().element_sum(), window, whole: false }
    }
}

impl Fitter<'_> {
    /// The window of a map around a body; the body is what it is around afterwards.
    pub(crate) fn lay_out(&self, body: &mut FocusBody, frame: &mut ShadowFrame) -> Layout {
        match (self.how.stabilise, self.how.warp) {
            (Stabilise::Off, Warp::Uniform) => self.tight(body),
            (Stabilise::Off, Warp::Focused) => self.focused(body, frame),
            (Stabilise::SnapTexels, Warp::Uniform) => self.still(body, Why::AlreadyStill, frame),
            (Stabilise::Off, warp) => self.warped(body, warp, self.how.guard, frame),
            (Stabilise::SnapTexels, _) => self.snapped(body, frame),
        }
    }

    /// The window of nearly least area around a body.
    fn tight(&self, body: &FocusBody) -> Layout {
        let margin = rounding_margin(&body.vertices, self.input.origin);
        let window = Window::steady(LightSpace::fixed(self.travel), Bend::NONE, &body.vertices, margin);
        Layout::uniform(window)
    }

    /// The window of nearly least area around what is in view; around the whole scene where that has hardly larger
    /// texels, because a map that does not follow the camera need not be drawn anew. The body is what the window is
    /// around.
    fn focused(&self, body: &mut FocusBody, frame: &mut ShadowFrame) -> Layout {
        let tight = self.tight(body);
        let window = &tight.window;
        // Most windows are far smaller than any window around the bounds: no need to fit the scene.
        let scene = &self.input.scene;
        let both = Aabb::new(scene.casters.min.max(scene.receivers.min), scene.casters.max.min(scene.receivers.max));
        let meet = both.min.cmple(both.max).all();
        if meet && window.area() <= WORTH_FOCUSING * least_area(&both, self.travel) {
            return tight;
        }
        let Ok(whole) = FocusBody::of_scene(scene, self.travel, self.input.origin) else { return tight };
        let still = self.tight(&whole);
        let share = (window.area() / still.window.area()).min(1.0);
        if share <= WORTH_FOCUSING {
            return tight;
        }
        frame.leave_out(Part::Window(self.index), Why::SceneIsInView { share });
        *body = whole;
        Layout { whole: true, ..still }
    }

    /// The window of the whole scene, which does not move with the camera.
    fn still(&self, whole: &FocusBody, why: Why, frame: &mut ShadowFrame) -> Layout {
        frame.leave_out(Part::Stabilise(self.index), why);
        let window = snap::still(&self.around(whole), self.texels.over_window(), self.input.origin);
        Layout { whole: true, ..Layout::uniform(window) }
    }

    /// The window of constant size that moves with the camera by whole texels; the still one where that is smaller. The
    /// body is what the window is around.
    fn snapped(&self, body: &mut FocusBody, frame: &mut ShadowFrame) -> Layout {
        let Ok(whole) = FocusBody::of_scene(&self.input.scene, self.travel, self.input.origin) else {
            return self.still(body, Why::AlreadyStill, frame);
        };
        match snap::snapped(
            &self.input.camera,
            body.depth,
            &self.around(&whole),
            self.texels.over_window(),
            self.input.origin,
        ) {
            Ok(window) => Layout::uniform(window),
            Err(why) => {
                *body = whole;
                self.still(body, why, frame)
            }
        }
    }

    /// The window around what is in view, bent by what a warp chooses; a guard limits it to what is predicted to be no
    /// worse than uniform.
    fn warped(&self, body: &FocusBody, warp: Warp, guard: bool, frame: &mut ShadowFrame) -> Layout {
        let (camera, origin) = (&self.input.camera, self.input.origin);
        let margin = rounding_margin(&body.vertices, origin);
        // Choose an axis and a strength.
        let sight = Sight::of(camera, self.travel, &body.vertices, origin);
        let margin_of_casters = self.margin_of_casters(body);
        let limit = |around: &WarpFrame| self.strongest(around, &sight, margin, margin_of_casters);
        let before = Held::by(frame);
        let held = before.as_ref().map(|before| |place: DVec3| before.holds(place));
        let held = held.as_ref().map(|held| held as &dyn Fn(DVec3) -> bool);
        let [seen, served] = Seen::of(camera, body, &sight, self.input.scene.visible_points, origin, held);
        let mut predicted = None;
        let choice = match warp {
            Warp::Uniform | Warp::Focused => Choice { frame: sight.frame, strength: 0.0 },
            Warp::Fixed { strength } => Choice { frame: sight.frame_along(sight.view), strength: f64::from(strength) },
            Warp::Trapezoidal { focus } => trapezoid::choose(camera, &sight, focus),
            Warp::LightSpacePerspective => lispsm::choose(&sight),
            Warp::Perspective { pull_back } => perspective::choose(camera, &sight, f64::from(pull_back)),
            Warp::Minimax => minimax::choose(&sight, limit(&sight.frame)),
            Warp::LeastError => {
                let frame = sight.frame_along(seen.axis(&sight));
                let own = Predictor::along(&frame, &seen, &sight);
                let limit = limit(&frame);
                let strength = if served == seen {
                    own.least(limit)
                } else {
                    own.least_sparing(&own.of_others(&frame, &served, &sight), limit)
                };
                predicted = Some(own);
                Choice { frame, strength }
            }
        };
        let (around, limit, asked) = (choice.frame, limit(&choice.frame), choice.strength);
        let predictor = predicted.unwrap_or_else(|| Predictor::along(&around, &seen, &sight));
        // Limit it to what texels and positions allow, and to what pays.
        let allowed = asked.min(limit);
        if asked > limit {
            frame.leave_out(Part::Warp(self.index), Why::WarpTooStrong { asked, limit });
        }
        let guarded = guard && warp.is_published();
        let strength = if guarded { predictor.guarded(allowed * sight.directed()) } else { allowed };
        if strength < allowed {
            frame.leave_out(Part::Warp(self.index), Why::WarpDoesNotPay { asked: allowed, limit: strength });
        }
        // Bend, and lay the window: on the axis as published, else where it is smallest.
        let bend = Bend::new(&around, strength / around.extent);
        let window = if warp.is_published() && !guard {
            Window::turned(sight.light, bend, around.axis, &body.vertices, margin)
        } else {
            Window::steady(sight.light, bend, &body.vertices, margin)
        };
        // Against the uniform map of the same axis: windows are laid where they are smallest, whatever the axis.
        let on_axis = predictor.error(strength);
        let error =
            if around == sight.frame { on_axis } else { uniform_error(&sight) * (on_axis / predictor.error(0.0)) };
        Layout { window, strength, error, whole: false }
    }

    /// The largest κλ that a map of these texels takes in a frame, positions of receivers and casters being uncertain
    /// by these margins. None for bodies that are no longer than their positions are uncertain.
    fn strongest(&self, around: &WarpFrame, sight: &Sight, margin: f64, margin_of_casters: f64) -> f64 {
        let extent = around.extent;
        let by_border = MOST_HORIZON * self.texels.over_window() / self.texels.border();
        let by_receivers = MOST_ROUNDING * (extent / margin - 1.0).max(0.0);
        let by_casters = MOST_ROUNDING_OF_CASTERS * extent / margin_of_casters;
        // f64 bends a point by the distance from the anchor times what W loses, which grows with that distance as well.
        let furthest = |reach: f64, point: &DVec2| reach.max(point.length_squared());
        let reach = sight.points.iter().fold(around.top.length_squared(), furthest).sqrt();
        let by_distance = MOST_ROUNDING / (ROUNDINGS * f64::EPSILON) * (extent / (2.0 * reach)).powi(2);
        STRONGEST.min(by_border).min(by_receivers).min(by_casters).min(by_distance)
    }

    /// What f32 may lose of the positions of casters, which stand before the body as far as their bounds reach towards
    /// the light.
    fn margin_of_casters(&self, body: &FocusBody) -> f64 {
        let casters = &self.input.scene.casters;
        let first = self.travel.dot(casters.centre() - self.input.origin) - self.travel.abs().dot(casters.half_size());
        let last = body.vertices.iter().map(|vertex| self.travel.dot(*vertex)).fold(f64::NEG_INFINITY, f64::max);
        let reach = body.vertices.iter().fold(0.0, |reach: f64, vertex| reach.max(vertex.abs().max_element()));
        rounding(reach + (last - first).max(0.0), self.input.origin)
    }

    /// The window around a body in the fixed frame of the light.
    fn around(&self, body: &FocusBody) -> Window {
        let margin = rounding_margin(&body.vertices, self.input.origin);
        Window::around(LightSpace::fixed(self.travel), Bend::NONE, &body.vertices, margin)
    }
}

/// Area of the smallest rectangle around a box as the light sees it: a hexagon of three pairs of edges, one of which
/// the rectangle is flush with.
fn least_area(bounds: &Aabb, travel: DVec3) -> f64 {
    let size = bounds.max - bounds.min;
    let light = LightSpace::fixed(travel);
    let edges = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| light.ray(axis * size).truncate());
    let flush = |side: DVec2| {
        let reach =
            edges.iter().fold(DVec2::ZERO, |sum, edge| sum + DVec2::new(side.dot(*edge), side.perp_dot(*edge)).abs());
        reach.element_product() / side.length_squared()
    };
    // An edge along the light is no side: its 0/0 is ignored.
    edges.into_iter().map(flush).fold(f64::INFINITY, f64::min)
}
