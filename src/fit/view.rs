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
    pub(crate) inner: f64,
    /// Texels of border on each side.
    pub(crate) border: f64,
}

impl Texels {
    /// The filter reads up to its reach beyond a point that the bias has moved by up to √2 reaches across the light; one
    /// more texel absorbs snapping. Maps too small for that border keep a third of their side inside.
    pub(crate) fn of(side: u32, filter: Pcf) -> Self {
        let side = f64::from(side);
        let wanted = (filter.reach() * (1.0 + core::f64::consts::SQRT_2)).ceil() + 1.0;
        let border = wanted.min((side / 3.0).floor());
        Self { inner: side - 2.0 * border, border }
    }
}

impl Fitter<'_> {
    /// The window of least area around a body.
    pub(crate) fn tight(&self, body: &FocusBody, frame: &mut ShadowFrame) -> Window {
        let margin = rounding_margin(&body.vertices);
        let window = Window::least_area(LightSpace::fixed(self.travel), &body.vertices);
        if window.size().min_element() < margin {
            frame.leave_out(Part::Window(0), Why::Degenerate { widened_to: 2.0 * margin });
        }
        window.grown(margin)
    }

    /// The whole scene's body, where focusing on `window` would shrink texels by too little to be worth a map that has to
    /// be drawn anew whenever the camera moves.
    pub(crate) fn not_worth_focusing(&self, window: &Window) -> Option<(FocusBody, f64)> {
        // Most windows are far smaller than the scene's bounds as the light sees them: no need to fit the scene.
        let scene = &self.input.scene;
        if scene.casters == scene.receivers && window.area() <= WORTH_FOCUSING * lit_area(&scene.receivers, self.travel)
        {
            return None;
        }
        let whole = FocusBody::of_scene(scene, self.travel, self.input.origin).ok()?;
        let still = Window::least_area(LightSpace::fixed(self.travel), &whole.vertices);
        let share = window.area() / still.area();
        (share > WORTH_FOCUSING).then_some((whole, share))
    }

    /// The window of the whole scene, which does not move with the camera.
    pub(crate) fn still(&self, body: &FocusBody, frame: &mut ShadowFrame) -> Window {
        frame.leave_out(Part::Stabilise(0), Why::AlreadyStill);
        snap::still(&self.whole_scene(body), self.texels.inner, self.input.origin)
    }

    /// The window of constant size that moves with the camera by whole texels; the still one where that is smaller.
    pub(crate) fn snapped(&self, body: &FocusBody, frame: &mut ShadowFrame) -> Window {
        let camera = &self.input.camera;
        let (_, far) = camera.projection.depth_range();
        let far = self.input.scene.visible_depth.map_or(far, |visible| far.min(visible.far));
        let margin = rounding_margin(&body.vertices);
        snap::snapped(camera, far, margin, &self.whole_scene(body), self.texels.inner, self.input.origin)
            .unwrap_or_else(|| self.still(body, frame))
    }

    /// The window of the receivers of the whole scene, in the fixed frame of the light.
    fn whole_scene(&self, body: &FocusBody) -> Window {
        let whole = FocusBody::of_scene(&self.input.scene, self.travel, self.input.origin);
        let vertices = whole.as_ref().map_or(&body.vertices, |scene| &scene.vertices);
        Window::around(LightSpace::fixed(self.travel), vertices).grown(rounding_margin(vertices))
    }

    /// From a window to a view and its uniforms, appended to the frame.
    pub(crate) fn view(&self, body: &FocusBody, window: &Window, frame: &mut ShadowFrame) {
        let input = self.input;
        // Texels, and a border of them around the window for the filter and the bias.
        let light = &window.light;
        let texel = window.size() / self.texels.inner;
        let low = window.low - texel * self.texels.border;
        let high = window.high + texel * self.texels.border;
        // Casters, and the depth that they and the receivers need.
        let farthest = body.vertices.iter().map(|v| light.travel().dot(*v)).fold(f64::NEG_INFINITY, f64::max);
        let cull = cull::prism(light, low, high, farthest, input.origin);
        let depth =
            DepthAlongLight::of(light, &body.vertices, &input.scene, &cull).widened(rounding_margin(&body.vertices));
        // One matrix, in f64, narrowed once.
        let clip_from_ray = Map::crop(low.extend(depth.near), high.extend(depth.far));
        let clip_from_render = clip_from_ray * light.ray_from_render();
        // What the receiver shader reads.
        let mut uniforms = affine_uniforms(&clip_from_render);
        self.bias.write(&self.bias_input(body, light, texel, depth, &clip_from_render), &mut uniforms);
        let (pixels, domain) = footprint(&input.camera, &body.vertices, input.origin, texel.max_element());
        let index = frame.views.len();
        let view = ShadowView {
            clip_from_render: clip_from_render.narrow(),
            depth_from_render: clip_from_render.narrow_row(2),
            viewport: UVec4::new(0, 0, input.map.side, input.map.side),
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
        light: &'b LightSpace,
        texel: DVec2,
        depth: DepthAlongLight,
        clip_from_render: &'b Map<Clip, Render>,
    ) -> BiasInput<'b> {
        let reach = body.vertices.iter().fold(DVec3::ZERO, |reach, vertex| reach.max(vertex.abs()));
        let side = f64::from(self.input.map.side);
        BiasInput { light, texel, depth_range: depth.far - depth.near, clip_from_render, reach, side }
    }
}

/// Area of a box as the light sees it: no window around it is smaller.
fn lit_area(bounds: &Aabb, travel: DVec3) -> f64 {
    let size = bounds.max - bounds.min;
    travel.abs().dot(DVec3::new(size.y * size.z, size.x * size.z, size.x * size.y))
}

/// The rows that the receiver shader needs, for a map with w = 1: texture coordinates from clip coordinates, and depth.
fn affine_uniforms(clip_from_render: &Map<Clip, Render>) -> ViewUniforms {
    let half = |row: usize, sign: f64| {
        let row = clip_from_render.row(row) * (0.5 * sign);
        row.truncate().extend(row.w + 0.5).as_vec4().to_array()
    };
    ViewUniforms {
        u_from_render: half(0, 1.0),
        v_from_render: half(1, -1.0),
        w_from_render: [0.0, 0.0, 0.0, 1.0],
        depth_from_render: clip_from_render.narrow_row(2).to_array(),
        rect: [0.0, 0.0, 1.0, 1.0],
        ..ViewUniforms::LIT
    }
}
