//! From a body to a view: window, texels, casters, depth, matrix, bias.

use glam::{DVec2, DVec3, DVec4, UVec4};

use crate::aliasing::extremes;
use crate::fit::bias::{Bias, BiasInput};
use crate::fit::cull;
use crate::fit::depth_range::{DepthAlongLight, rounding_margin};
use crate::fit::layout::Layout;
use crate::frame::{Pcf, ShadowFrame, ShadowView, TexelSize, ViewUniforms};
use crate::math::space::{Clip, Map, Render};
use crate::report::{Part, Why};
use crate::technique::FitInput;
use crate::warp::window::Window;

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

    /// Texels of border on each side, at least one.
    pub(crate) fn border(&self) -> f64 {
        f64::from(self.border.max(1))
    }

    /// Texels over the window, as a divisor.
    pub(crate) fn over_window(&self) -> f64 {
        f64::from(self.inner)
    }
}

impl Fitter<'_> {
    /// From a window to a view and its uniforms, appended to the frame.
    pub(crate) fn view(&self, &Layout { ref body, ref window, strength, error }: &Layout, frame: &mut ShadowFrame) {
        let (input, texels) = (self.input, &self.texels);
        let margin = rounding_margin(&body.vertices, self.input.origin);
        // Texels, and a border of them around the window for the filter and the bias; all but a ring of it is drawn.
        let light = &window.light;
        let texel = window.size() / texels.over_window();
        let drawn = window.bordered(texel * f64::from(texels.border - texels.ring));
        // Casters, and the depth that they and the receivers need.
        let last = body.vertices.iter().map(|v| light.travel().dot(*v)).fold(f64::NEG_INFINITY, f64::max);
        let cull = cull::prism(&drawn, last + margin, input.origin);
        let Some(depth) = DepthAlongLight::of(&drawn, &body.vertices, &input.scene, &cull) else {
            return frame.leave_out(Part::Light, Why::NothingCastsHere);
        };
        let depth = depth.widened(margin);
        // One matrix, in f64, narrowed once; and what the receiver shader reads.
        let clip_from_render = drawn.clip_from_ray(depth.near, depth.far) * light.ray_from_render();
        let rows = self.texture_rows(&clip_from_render);
        let mut uniforms = self.uniforms(&rows, &clip_from_render);
        self.bias.write(&self.bias_input(&drawn, &body.vertices, &rows, depth, &clip_from_render), &mut uniforms);
        let sides = |vertex: DVec3| drawn.texel_at(light.ray(vertex).truncate(), texel).map(DVec2::length);
        let same = window.bend.is_none().then(|| texel.to_array());
        let mut extremes =
            extremes(&input.camera, &body.vertices, input.origin, |vertex| same.unwrap_or_else(|| sides(vertex)));
        extremes.pixels.error = (0.5 * error / texels.over_window()).min(f64::from(f32::MAX)) as f32;
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
            texel: TexelSize { world: extremes.world, pixels: extremes.pixels },
            warp_strength: strength as f32,
            domain: extremes.domain,
        };
        if frame.views.try_push(view).is_ok() {
            frame.uniforms.views[index] = uniforms;
            frame.uniforms.counts[0] += 1;
            frame.predicted = extremes.pixels;
        }
    }

    fn bias_input<'b>(
        &self,
        drawn: &'b Window,
        vertices: &[DVec3],
        texture_from_render: &'b [DVec4; 3],
        depth: DepthAlongLight,
        clip_from_render: &'b Map<Clip, Render>,
    ) -> BiasInput<'b> {
        let reach = vertices.iter().fold(DVec3::ZERO, |reach, vertex| reach.max(vertex.abs()));
        let (side, ring) = (self.input.map.side, self.texels.ring);
        let texel = drawn.size() / f64::from(side - 2 * ring);
        let depth_range = depth.far - depth.near;
        BiasInput {
            window: drawn,
            texel,
            depth_range,
            clip_from_render,
            texture_from_render,
            reach,
            side: f64::from(side),
        }
    }

    /// The rows of u, v and w: texture coordinates (times w) from clip coordinates, the viewport's share of the map.
    fn texture_rows(&self, clip_from_render: &Map<Clip, Render>) -> [DVec4; 3] {
        let ring = f64::from(self.texels.ring) / f64::from(self.input.map.side);
        let half = 0.5 - ring;
        let w = clip_from_render.row(3);
        [clip_from_render.row(0) * half + w * 0.5, clip_from_render.row(1) * -half + w * 0.5, w]
    }

    /// What the receiver shader needs besides the bias.
    fn uniforms(&self, texture_from_render: &[DVec4; 3], clip_from_render: &Map<Clip, Render>) -> ViewUniforms {
        let [u, v, w] = texture_from_render.map(|row| row.as_vec4().to_array());
        let ring = f64::from(self.texels.ring) / f64::from(self.input.map.side);
        let (low, high) = (ring as f32, (1.0 - ring) as f32);
        ViewUniforms {
            u_from_render: u,
            v_from_render: v,
            w_from_render: w,
            depth_from_render: clip_from_render.narrow_row(2).to_array(),
            rect: [low, low, high, high],
            ..ViewUniforms::LIT
        }
    }
}
