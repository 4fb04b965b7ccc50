//! The composite: stages in order.

use glam::{DVec3, UVec4};

use crate::aliasing::footprint;
use crate::error::FitError;
use crate::fit::bias::{Bias, BiasInput};
use crate::fit::depth_range::{DepthAlongLight, least_extent};
use crate::fit::{cull, snap};
use crate::focus::FocusBody;
use crate::frame::{Pcf, ShadowFrame, ShadowView, TexelSize, ViewUniforms, WgslKey};
use crate::light::Light;
use crate::light_space::LightSpace;
use crate::math::space::{Clip, Map, Render};
use crate::report::{Part, Why};
use crate::technique::{FitInput, ShadowTechnique};
use crate::warp::uniform::Window;

/// How the light's coordinates are laid out on a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warp {
    /// Uniform over the whole scene as the light sees it. View-independent: the map of a still scene can be kept.
    Uniform,
    /// Uniform over what is in view.
    #[default]
    Focused,
}

/// What a map stores, and how it is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Encoding {
    /// Linear light depth, percentage-closer filtered.
    Depth(Pcf),
}

impl Default for Encoding {
    fn default() -> Self {
        Self::Depth(Pcf::default())
    }
}

/// Whether texels keep their place in the world while the camera moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stabilise {
    /// The tightest fit; edges may crawl when the camera moves.
    #[default]
    Off,
    /// A window of constant size that moves by whole texels: edges never crawl, for a larger window.
    SnapTexels,
}

/// A technique, as a choice of stages. Every combination is legal; the named ones are in [`techniques`](crate::techniques).
///
/// ```
/// use antumbra::{Encoding, Pcf, Remix, Stabilise};
/// let soft_and_still = Remix { encoding: Encoding::Depth(Pcf::Box5x5), stabilise: Stabilise::SnapTexels, ..Remix::default() };
/// # let _ = soft_and_still;
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Remix {
    /// Layout of a map. Default: focused, because it costs nothing and never has larger texels.
    pub warp: Warp,
    /// What is stored and how it is read. Default: hardware 2×2, one texture sample.
    pub encoding: Encoding,
    /// Default: automatic.
    pub bias: Bias,
    /// Default: off, the sharpest.
    pub stabilise: Stabilise,
}

impl ShadowTechnique for Remix {
    fn wgsl_key(&self) -> WgslKey {
        let Encoding::Depth(filter) = self.encoding;
        WgslKey { filter }
    }

    fn fit(&self, input: &FitInput) -> Result<ShadowFrame, FitError> {
        // Check the inputs at the door.
        let input = input.validate()?;
        self.bias.validate()?;
        let travel = directional(&input.light)?;
        let mut frame = ShadowFrame::lit(self.wgsl_key());
        // Find what has to be in the map.
        let body = match self.warp {
            Warp::Uniform => FocusBody::of_scene(&input.scene, travel, input.origin),
            Warp::Focused => FocusBody::of_view(&input.camera, &input.scene, travel, input.origin),
        };
        let body = match body {
            Ok(body) => body,
            Err(reason) => {
                frame.leave_out(reason.part, reason.why);
                return Ok(frame);
            }
        };
        if let Some(why) = body.left_out {
            frame.leave_out(Part::Receivers(0), why);
        }
        // Lay it out, and draw the conclusions.
        let texels = Texels::of(&input, self.wgsl_key());
        let mut window = self.window(&input, &body, travel, &texels, &mut frame);
        let least = least_extent(&body.vertices, window.low);
        if window.widen(least) {
            frame.leave_out(Part::Window(0), Why::Degenerate { widened_to: least });
        }
        self.assemble(&input, &body, &window, &texels, least, &mut frame);
        Ok(frame)
    }
}

impl Remix {
    /// The extent of the map across the light.
    fn window(
        &self,
        input: &FitInput,
        body: &FocusBody,
        travel: DVec3,
        texels: &Texels,
        frame: &mut ShadowFrame,
    ) -> Window {
        let light = LightSpace::fixed(travel);
        match (self.stabilise, self.warp) {
            (Stabilise::Off, _) => Window::least_area(light, &body.vertices),
            (Stabilise::SnapTexels, Warp::Uniform) => {
                frame.leave_out(Part::Stabilise(0), Why::AlreadyStill);
                snap::still(&Window::around(light, &body.vertices), texels.inner, &light, input.origin)
            }
            (Stabilise::SnapTexels, Warp::Focused) => {
                let (_, far) = input.camera.projection.depth_range();
                let far = input.scene.visible_depth.map_or(far, |visible| far.min(visible.far));
                let scene = match FocusBody::of_scene(&input.scene, travel, input.origin) {
                    Ok(scene) => Window::around(light, &scene.vertices),
                    Err(_) => Window::around(light, &body.vertices),
                };
                snap::snapped(&input.camera, far, &scene, texels.inner, input.origin).unwrap_or_else(|| {
                    frame.leave_out(Part::Stabilise(0), Why::AlreadyStill);
                    snap::still(&scene, texels.inner, &light, input.origin)
                })
            }
        }
    }

    /// From a window to a view and its uniforms.
    fn assemble(
        &self,
        input: &FitInput,
        body: &FocusBody,
        window: &Window,
        texels: &Texels,
        least: f64,
        frame: &mut ShadowFrame,
    ) {
        // Texels, and a border of them around the window for the filter and the bias.
        let light = &window.light;
        let texel = window.size() / texels.inner;
        let low = window.low - texel * texels.border;
        let high = window.high + texel * texels.border;
        // Casters and the depth range they need.
        let farthest = body.vertices.iter().map(|v| light.travel().dot(*v)).fold(f64::NEG_INFINITY, f64::max);
        let cull = cull::prism(light, low, high, farthest, input.origin);
        let depth = DepthAlongLight::of(light, &body.vertices, &input.scene, &cull).at_least(least);
        // One matrix, in f64, narrowed once.
        let clip_from_ray = Map::crop(low.extend(depth.near), high.extend(depth.far));
        let clip_from_render = clip_from_ray * light.ray_from_render();
        let reach = body.vertices.iter().fold(DVec3::ZERO, |reach, vertex| reach.max(vertex.abs()));
        let side = f64::from(input.map.side);
        let mut uniforms = affine_uniforms(&clip_from_render);
        let depth_range = depth.far - depth.near;
        let bias = BiasInput { light, texel, depth_range, clip_from_render: &clip_from_render, reach, side };
        self.bias.write(&bias, &mut uniforms);
        let (pixels, domain) = footprint(&input.camera, &body.vertices, input.origin, texel.max_element());
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
        frame.uniforms.views[0] = uniforms;
        frame.uniforms.counts[0] = 1;
        frame.predicted = pixels;
        let _ = frame.views.try_push(view); // the first of MAX_VIEWS
    }
}

/// Texels over the side of a window, and the border around them.
struct Texels {
    inner: f64,
    border: f64,
}

impl Texels {
    /// The filter reads up to its reach beyond a point that the bias has moved by up to √2 reaches across the light; one
    /// more texel absorbs snapping. Maps too small for that border keep a third of their side inside.
    fn of(input: &FitInput, key: WgslKey) -> Self {
        let side = f64::from(input.map.side);
        let wanted = (key.filter.reach() * (1.0 + core::f64::consts::SQRT_2)).ceil() + 1.0;
        let border = wanted.min((side / 3.0).floor());
        Self { inner: side - 2.0 * border, border }
    }
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

/// The travel of a directional light; other lights are not served yet.
fn directional(light: &Light) -> Result<DVec3, FitError> {
    let value = match *light {
        Light::Directional { travel } => return Ok(travel),
        Light::Spot { .. } => "a spot light",
        Light::Point { .. } => "a point light",
    };
    Err(FitError::NotYet { field: "light", value, legal: "directional lights" })
}
