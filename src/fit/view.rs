//! From a body to a view: window, texels, casters, depth, matrix, bias.

use glam::{DVec2, DVec3, UVec4};

use crate::aliasing::footprint;
use crate::fit::bias::{Bias, BiasInput};
use crate::fit::depth_range::{DepthAlongLight, rounding_margin};
use crate::fit::{cull, snap};
use crate::focus::FocusBody;
use crate::frame::{Pcf, ShadowFrame, ShadowView, TexelSize, ViewUniforms};
use crate::light_space::LightSpace;
use crate::math::space::{Clip, Map, Render};
use crate::report::{Part, Why};
use crate::scene::Aabb;
use crate::technique::FitInput;
use crate::warp::uniform::Window;

/// A focused window is used when its area is at most this share of the whole scene's. At 1 every map follows the camera for
/// next to nothing; at 0.8 texels would be given away that a picture shows (a tenth of their side, about a tenth of the
/// error). At 0.9 the still map costs at most 5 % of a texel's side, and can be kept as long as the scene is still.
const WORTH_FOCUSING: f64 = 0.9;

/// What a body is fitted with.
pub(crate) struct Fitter<'a> {
    /// The checked input.
    pub(crate) input: &'a FitInput<'a>,
    /// Travel of the directional light, unit length.
    pub(crate) travel: DVec3,
    /// Texels of the map.
    pub(crate) texels: Texels,
    /// How receivers are kept from shadowing themselves.
    pub(crate) bias: Bias,
}

/// Texels over the side of a window, and the border around them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Texels {
    /// Texels over the window, along a side.
    inner: u32,
    /// Texels of border on each side, the ring among them.
    border: u32,
    /// Texels on each side that are never drawn: cleared to "lit", they answer for everything outside.
    ring: u32,
    /// Texels of border that the filter wants.
    wanted: u32,
}

impl Texels {
    /// The filter reads up to its reach beyond a point that the bias has moved by up to √2 reaches across the light; one
    /// more texel absorbs snapping, and one is the ring. Maps that are too small for that have what they can.
    pub(crate) fn of(side: u32, filter: Pcf) -> Self {
        let wanted = (filter.reach() * (1.0 + core::f64::consts::SQRT_2)).ceil() as u32 + 2;
        let border = wanted.min(side.saturating_sub(1) / 2);
        Self { inner: side - 2 * border, border, ring: border.min(1), wanted }
    }

    /// Texels over the window, as a divisor.
    fn inner(&self) -> f64 {
        f64::from(self.inner)
    }
}

/// A body, and the window that is laid around it.
pub(crate) type Layout = (FocusBody, Window);

impl Fitter<'_> {
    /// The window of least area around a body.
    pub(crate) fn tight(&self, body: FocusBody) -> Layout {
        let window = Window::least_area(LightSpace::fixed(self.travel), &body.vertices);
        let window = window.grown(rounding_margin(&body.vertices, self.input.origin));
        (body, window)
    }

    /// The window of least area around what is in view; around the whole scene where that has hardly larger texels, because
    /// a map that does not follow the camera need not be drawn anew.
    pub(crate) fn focused(&self, body: FocusBody, frame: &mut ShadowFrame) -> Layout {
        let (body, window) = self.tight(body);
        // Most windows are far smaller than the bounds as the light sees them: no need to fit the scene.
        let scene = &self.input.scene;
        let both = Aabb::new(scene.casters.min.max(scene.receivers.min), scene.casters.max.min(scene.receivers.max));
        let meet = both.min.cmple(both.max).all();
        if meet && window.area() <= WORTH_FOCUSING * lit_area(&both, self.travel) {
            return (body, window);
        }
        let Ok(whole) = FocusBody::of_scene(scene, self.travel, self.input.origin) else { return (body, window) };
        let (whole, still) = self.tight(whole);
        let share = (window.area() / still.area()).min(1.0);
        if share <= WORTH_FOCUSING {
            return (body, window);
        }
        frame.leave_out(Part::Window(0), Why::SceneIsInView { share });
        (whole, still)
    }

    /// The window of the whole scene, which does not move with the camera.
    pub(crate) fn still(&self, whole: FocusBody, why: Why, frame: &mut ShadowFrame) -> Layout {
        frame.leave_out(Part::Stabilise(0), why);
        let window = snap::still(&self.around(&whole), self.texels.inner(), self.input.origin);
        (whole, window)
    }

    /// The window of constant size that moves with the camera by whole texels; the still one where that is smaller.
    pub(crate) fn snapped(&self, body: FocusBody, frame: &mut ShadowFrame) -> Layout {
        let (camera, scene) = (&self.input.camera, &self.input.scene);
        let (_, far) = camera.projection.depth_range();
        let far = scene.visible_depth.map_or(far, |visible| far.min(visible.far));
        let Ok(whole) = FocusBody::of_scene(scene, self.travel, self.input.origin) else {
            return self.still(body, Why::AlreadyStill, frame);
        };
        match snap::snapped(camera, far, &self.around(&whole), self.texels.inner(), self.input.origin) {
            Ok(window) => (body, window),
            Err(why) => self.still(whole, why, frame),
        }
    }

    /// The window around a body in the fixed frame of the light.
    fn around(&self, body: &FocusBody) -> Window {
        let window = Window::around(LightSpace::fixed(self.travel), &body.vertices);
        window.grown(rounding_margin(&body.vertices, self.input.origin))
    }

    /// From a window to a view and its uniforms, appended to the frame.
    pub(crate) fn view(&self, (body, window): &Layout, frame: &mut ShadowFrame) {
        let (input, texels) = (self.input, &self.texels);
        let margin = rounding_margin(&body.vertices, self.input.origin);
        // Texels, and a border of them around the window for the filter and the bias; all but a ring of it is drawn.
        let light = &window.light;
        let texel = window.size() / texels.inner();
        let border = texel * f64::from(texels.border - texels.ring);
        let (low, high) = (window.low - border, window.high + border);
        // Casters, and the depth that they and the receivers need.
        let last = body.vertices.iter().map(|v| light.travel().dot(*v)).fold(f64::NEG_INFINITY, f64::max);
        let cull = cull::prism(light, low, high, last + margin, input.origin);
        let Some(depth) = DepthAlongLight::of(light, &body.vertices, &input.scene, &cull) else {
            return frame.leave_out(Part::Light, Why::NothingCastsHere);
        };
        let depth = depth.widened(margin);
        // One matrix, in f64, narrowed once; and what the receiver shader reads.
        let clip_from_ray = Map::crop(low.extend(depth.near), high.extend(depth.far));
        let clip_from_render = clip_from_ray * light.ray_from_render();
        let mut uniforms = self.affine_uniforms(&clip_from_render);
        self.bias.write(&self.bias_input(body, texel, depth, &clip_from_render), &mut uniforms);
        let (pixels, domain) = footprint(&input.camera, &body.vertices, input.origin, texel.max_element());
        // Say what was cut.
        if window.size().min_element() < 3.0 * margin {
            frame.leave_out(Part::Window(0), Why::Degenerate { widened_to: window.size().min_element() });
        }
        if texels.border < texels.wanted {
            frame.leave_out(Part::Border(0), Why::MapTooSmall { border: texels.border, wanted: texels.wanted });
        }
        let ring = texels.ring;
        let index = frame.views.len();
        let view = ShadowView {
            clip_from_render: clip_from_render.narrow(),
            depth_from_render: clip_from_render.narrow_row(2),
            viewport: UVec4::new(ring, ring, input.map.side - 2 * ring, input.map.side - 2 * ring),
            layer: 0,
            cull,
            texel: TexelSize { world: [texel.min_element() as f32, texel.max_element() as f32], pixels },
            warp_strength: 0.0,
            domain,
        };
        if frame.views.try_push(view).is_ok() {
            frame.uniforms.views[index] = uniforms;
            frame.uniforms.counts[0] += 1;
            frame.predicted = pixels;
        }
    }

    fn bias_input<'b>(
        &self,
        body: &FocusBody,
        texel: DVec2,
        depth: DepthAlongLight,
        clip_from_render: &'b Map<Clip, Render>,
    ) -> BiasInput<'b> {
        let reach = body.vertices.iter().fold(DVec3::ZERO, |reach, vertex| reach.max(vertex.abs()));
        let side = f64::from(self.input.map.side);
        BiasInput { texel, depth_range: depth.far - depth.near, clip_from_render, reach, side }
    }

    /// The rows that the receiver shader needs, for a map with w = 1: texture coordinates from clip coordinates, and depth.
    fn affine_uniforms(&self, clip_from_render: &Map<Clip, Render>) -> ViewUniforms {
        // The viewport's share of the map.
        let ring = f64::from(self.texels.ring) / f64::from(self.input.map.side);
        let half = 0.5 - ring;
        let row = |row: usize, sign: f64| {
            let row = clip_from_render.row(row) * (half * sign);
            row.truncate().extend(row.w + 0.5).as_vec4().to_array()
        };
        let (low, high) = (ring as f32, (1.0 - ring) as f32);
        ViewUniforms {
            u_from_render: row(0, 1.0),
            v_from_render: row(1, -1.0),
            w_from_render: [0.0, 0.0, 0.0, 1.0],
            depth_from_render: clip_from_render.narrow_row(2).to_array(),
            rect: [low, low, high, high],
            ..ViewUniforms::LIT
        }
    }
}

/// Area of a box as the light sees it: no window around it is smaller.
fn lit_area(bounds: &Aabb, travel: DVec3) -> f64 {
    let size = bounds.max - bounds.min;
    travel.abs().dot(DVec3::new(size.y * size.z, size.x * size.z, size.x * size.y))
}
