//! From a body to a view: window, texels, casters, depth, matrix, bias.

use glam::{DVec2, DVec3, DVec4, UVec4};

use crate::aliasing::extremes;
use crate::content::{Content, Made, Place, Tile};
use crate::encoding::stage::Encoding;
use crate::fit::bias::{Bias, BiasInput};
use crate::fit::blur::Placed;
use crate::fit::cull;
use crate::fit::depth_range::{DepthAlongLight, rounding, rounding_margin};
use crate::fit::layout::{How, Layout};
use crate::fit::snap::{self, Stabilise};
use crate::focus::FocusBody;
use crate::frame::{Pcf, ShadowFrame, ShadowView, TexelSize, ViewUniforms};
use crate::math::space::{Clip, Map, Render};
use crate::report::{Part, Why};
use crate::technique::FitInput;
use crate::texel::BlurUniforms;
use crate::warp::window::Window;

/// What a body is fitted with.
#[derive(Clone, Copy)]
pub(crate) struct Fitter<'a> {
    /// The checked input.
    pub(crate) input: &'a FitInput<'a>,
    /// Travel of the directional light, unit length.
    pub(crate) travel: DVec3,
    /// The map's texels in the layers.
    pub(crate) tile: Tile,
    /// What they are for.
    pub(crate) texels: Texels,
    /// How receivers are kept from shadowing themselves.
    pub(crate) bias: Bias,
    /// What texels store.
    pub(crate) encoding: Encoding,
    /// How windows are laid.
    pub(crate) how: How,
    /// Number of the view.
    pub(crate) index: u8,
    /// Number of the split that it is for.
    pub(crate) split: u8,
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
    /// What reads them.
    filter: Pcf,
    /// Texels that are blurred to either side before they are read.
    kernel: u32,
}

impl Texels {
    /// The filter reads up to its reach beyond a point that the bias has moved by up to √2 reaches across the light;
    /// one more texel absorbs snapping, and one is the ring. Maps that are too small for that have what they can.
    pub(crate) fn of(side: u32, filter: Pcf) -> Self {
        Self::with(side, filter, 0)
    }

    fn with(side: u32, filter: Pcf, kernel: u32) -> Self {
        let wanted = (filter.reach() * (1.0 + core::f64::consts::SQRT_2)).ceil() as u32 + 2 + kernel;
        let border = wanted.min(side.saturating_sub(1) / 2);
        Self { inner: side - 2 * border, border, ring: border.min(1), wanted, filter, kernel }
    }

    /// The same, blurred by so many texels to either side before they are read.
    pub(crate) fn blurred(self, kernel: u32) -> Self {
        Self::with(self.inner + 2 * self.border, self.filter, kernel)
    }

    /// Texels that are blurred to either side.
    pub(crate) fn kernel(&self) -> u32 {
        self.kernel
    }

    /// Those of a map of another side, for the same filter.
    pub(crate) fn of_side(self, side: u32) -> Self {
        Self::with(side, self.filter, self.kernel)
    }

    /// Why the border is smaller than its filter wants, if it is.
    pub(crate) fn too_small(&self) -> Option<Why> {
        (self.border < self.wanted).then_some(Why::MapTooSmall { border: self.border, wanted: self.wanted })
    }

    /// Texels from a receiver to the farthest one that a filter may read without reading outside: what
    /// [`with`](Self::with) takes a border for.
    pub(crate) fn widest_reach(&self) -> f64 {
        f64::from(self.border.saturating_sub(2 + self.kernel)) / (1.0 + core::f64::consts::SQRT_2)
    }

    /// What a filter reads beyond a receiver, and one texel more.
    pub(crate) fn read_beyond(&self) -> f64 {
        self.filter.reach() + 1.0
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

/// How far behind the last receiver and beyond the rim casters are drawn, as a multiple of what f32 loses of depths
/// along the light: where maps are found by containment, a receiver just behind a map is still looked up in it, as far
/// as its bias lifts it for rounding. 1 could cull its caster; more costs nothing to speak of.
const CASTERS_BEHIND: f64 = 16.0;

/// Parts of a texel that f32 may lose of the depth of a whole scene, for maps that are kept. At 1 contacts would leak
/// by a texel; towards 0 large scenes would not be kept.
const COARSEST_DEPTH: f64 = 0.05;

impl Fitter<'_> {
    /// From a window to a view and its uniforms, appended to the frame; `Err` where nothing casts into the window.
    pub(crate) fn view(&self, body: &FocusBody, layout: &Layout, frame: &mut ShadowFrame) -> Result<(), Why> {
        let &Layout { ref window, strength, error, .. } = layout;
        let (input, texels) = (self.input, &self.texels);
        let margin = rounding_margin(&body.vertices, self.input.origin);
        // Texels, and a border of them around the window for the filter and the bias; all but a ring of it is drawn.
        let light = &window.light;
        let texel = window.size() / texels.over_window();
        let drawn = window.bordered(texel * f64::from(texels.border - texels.ring));
        // Casters, and the depth that they and the receivers need.
        let last = body.vertices.iter().map(|v| light.travel().dot(*v)).fold(f64::NEG_INFINITY, f64::max);
        // What f32 moves across the rim is drawn where it is looked up.
        let rim = drawn.bordered(DVec2::splat(CASTERS_BEHIND * margin));
        let mut cull = cull::prism(&rim, last + margin, input.origin);
        let Some(depth) = DepthAlongLight::of(&drawn, &body.vertices, &input.scene, &cull) else {
            return Err(Why::NothingCastsHere);
        };
        let depth = self.steady_depth(window, texel).unwrap_or(depth.widened(margin));
        let lost = rounding(depth.near.abs().max(depth.far.abs()), input.origin);
        cull::end_at(&mut cull, depth.far + CASTERS_BEHIND * lost);
        // One matrix, in f64, narrowed once; and what the receiver shader reads.
        let clip_from_render = drawn.clip_from_ray(depth.near, depth.far) * light.ray_from_render();
        let rows = self.texture_rows(&clip_from_render);
        let mut uniforms = self.uniforms(&rows, &clip_from_render);
        let bias = self.bias_input(&drawn, &body.vertices, &rows, depth, &clip_from_render);
        self.bias.write(&bias, &mut uniforms);
        let placed =
            Placed { rows: &rows, across: bias.across().0, light, texel: bias.texel, receivers: &body.vertices };
        let blur = self.filter(&placed, bias.depth_range, &mut uniforms, frame);
        let squares = |vertex: DVec3| drawn.texel_at(light.ray(vertex).truncate(), texel).map(DVec2::length_squared);
        let same = window.bend.is_none().then(|| (texel * texel).to_array());
        let mut extremes =
            extremes(&input.camera, &body.vertices, input.origin, |vertex| same.unwrap_or_else(|| squares(vertex)));
        extremes.pixels.error = (0.5 * error / texels.over_window()).min(f64::from(f32::MAX)) as f32;
        self.bleeding(extremes.world[1], &cull, &mut uniforms, frame);
        self.report(window, margin, frame);
        let (ring, corner, drawn_side) = (texels.ring, self.tile.corner, self.tile.side - 2 * texels.ring);
        let view = ShadowView {
            clip_from_render: clip_from_render.narrow(),
            depth_from_render: clip_from_render.narrow_row(2),
            viewport: UVec4::new(corner.x + ring, corner.y + ring, drawn_side, drawn_side),
            layer: self.tile.layer,
            cull,
            texel: TexelSize { world: extremes.world, pixels: extremes.pixels },
            warp_strength: strength as f32,
            domain: extremes.domain,
            content: Content::Redraw,
            blur,
            place: Place {
                levels: self.encoding.levels(&uniforms),
                made: Made::by(frame.wgsl.texel, &blur),
                ..self.place(window, texel, depth)
            },
            split: self.split,
        };
        let before = input.previous.and_then(|before| before.views.get(usize::from(self.index)));
        let content = before.map_or(Content::Redraw, |before| Content::since(&before.place, &view.place));
        if frame.views.try_push(ShadowView { content, ..view }).is_ok() {
            frame.uniforms.views[usize::from(self.index)] = uniforms;
            frame.uniforms.counts[0] += 1;
        }
        Ok(())
    }

    /// Writes what the lookups of an encoding need, and gives what its passes need.
    fn filter(
        &self,
        placed: &Placed,
        depth_range: f64,
        uniforms: &mut ViewUniforms,
        frame: &mut ShadowFrame,
    ) -> BlurUniforms {
        match self.encoding {
            Encoding::Moments(prefilter) => return self.blur(&prefilter, placed, &self.texels, uniforms, frame),
            Encoding::Depth(Pcf::Pixel) => self.pixel(uniforms),
            Encoding::Depth(_) | Encoding::Soft { .. } => {}
        }
        if let Some(angle) = self.encoding.angle() {
            self.penumbra(angle, placed.texel, depth_range, uniforms, frame);
        }
        BlurUniforms::default()
    }

    /// Says what was cut of a view.
    fn report(&self, window: &Window, margin: f64, frame: &mut ShadowFrame) {
        let narrow = window.size().min_element();
        if narrow < 3.0 * margin {
            frame.leave_out(Part::Window(self.index), Why::Degenerate { widened_to: narrow });
        }
        if let Some(why) = self.texels.too_small() {
            frame.leave_out(Part::Border(self.index), why);
        }
        if self.tile.side < self.tile.of {
            frame.leave_out(Part::Texels(self.index), self.how.share.why(self.tile));
        }
    }

    /// The depth of snapped maps: the scene's, so that maps can be kept, where f32 resolves it to a part of a texel.
    fn steady_depth(&self, window: &Window, texel: DVec2) -> Option<DepthAlongLight> {
        if self.how.stabilise == Stabilise::Off {
            return None;
        }
        let (scene, origin) = (&self.input.scene, self.input.origin);
        let margin = snap::steady_margin(&scene.casters.union(scene.receivers), origin);
        let depth = DepthAlongLight::of_scene(&window.light, scene, origin);
        let steady = DepthAlongLight { near: depth.near - margin, far: depth.far + margin };
        (rounding(steady.far - steady.near, DVec3::ZERO) < COARSEST_DEPTH * texel.min_element()).then_some(steady)
    }

    /// Where a view's texels are in the world.
    fn place(&self, window: &Window, texel: DVec2, depth: DepthAlongLight) -> Place {
        let light = &window.light;
        let origin = light.ray(self.input.origin);
        Place {
            axes: [light.p(), light.q(), light.travel()],
            texel,
            low: window.low + origin.truncate(),
            depth: [depth.near + origin.z, depth.far + origin.z],
            tile: self.tile,
            uniform: window.bend.is_none(),
            ..Place::UNKNOWN
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
        let texel = drawn.size() / f64::from(self.tile.side - 2 * self.texels.ring);
        let depth_range = depth.far - depth.near;
        let (tile, tap_reach) = (self.tile, self.texels.filter.tap_reach());
        BiasInput { window: drawn, texel, depth_range, clip_from_render, texture_from_render, reach, tile, tap_reach }
    }

    /// Corner and side of the tile, and the width of its ring, texture coordinates.
    fn in_texture(&self) -> (DVec2, f64, f64) {
        let of = f64::from(self.tile.of);
        (self.tile.corner.as_dvec2() / of, f64::from(self.tile.side) / of, f64::from(self.texels.ring) / of)
    }

    /// The rows of u, v and w: texture coordinates (times w) from clip coordinates, the viewport's share of the layer.
    fn texture_rows(&self, clip_from_render: &Map<Clip, Render>) -> [DVec4; 3] {
        let (corner, side, ring) = self.in_texture();
        let (centre, half) = (corner + 0.5 * side, 0.5 * side - ring);
        let w = clip_from_render.row(3);
        [clip_from_render.row(0) * half + w * centre.x, clip_from_render.row(1) * -half + w * centre.y, w]
    }

    /// What the receiver shader needs besides the bias.
    fn uniforms(&self, texture_from_render: &[DVec4; 3], clip_from_render: &Map<Clip, Render>) -> ViewUniforms {
        let [u, v, w] = texture_from_render.map(|row| row.as_vec4().to_array());
        let (corner, side, ring) = self.in_texture();
        let (low, high) = (corner + ring, corner + side - ring);
        ViewUniforms {
            u_from_render: u,
            v_from_render: v,
            w_from_render: w,
            depth_from_render: clip_from_render.narrow_row(2).to_array(),
            rect: [low.x, low.y, high.x, high.y].map(|at| at as f32),
            ..ViewUniforms::LIT
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::remix::Remix;
    use crate::report::LeftOut;
    use crate::scene::{Aabb, MapBudget, Scene};
    use crate::technique::ShadowTechnique;
    use crate::warp::Warp;
    use crate::warp::bend::Bend;
    use crate::warp::sight::Sight;
    use glam::DMat4;

    const SIDE: u32 = 2048;
    const TRAVEL: DVec3 = DVec3::new(0.36, -0.8, 0.48);

    /// A view over open ground, `offset` away from the world's origin; render space around the eye, or around the
    /// world's origin.
    fn input(offset: f64, around_eye: bool) -> FitInput<'static> {
        let eye = DVec3::new(0.6, 0.48, -0.64) * offset;
        let world_from_view = DMat4::from_translation(eye) * DMat4::from_rotation_y(0.3);
        FitInput {
            camera: Camera::perspective(world_from_view, 1.0, 1.5, 0.1, 100.0),
            light: crate::Light::Directional { travel: TRAVEL },
            scene: Scene::within(Aabb::new(eye - 300.0, eye + 300.0)),
            map: MapBudget::one(SIDE),
            origin: if around_eye { eye } else { DVec3::ZERO },
            previous: None,
        }
    }

    /// Positions all over the view, world space.
    fn positions(camera: &Camera) -> impl Iterator<Item = DVec3> {
        let (origin, camera) = (camera.eye(), *camera);
        (0..9 * 9 * 9).map(move |index| {
            let [x, y, z] = [index % 9, index / 9 % 9, index / 81].map(|step| f64::from(step) / 8.0);
            let depth = 0.1 * 1000.0_f64.powf(z);
            let (start, direction) = camera.ray(camera.projection.size_at(1.0) * (DVec2::new(x, y) - 0.5), origin);
            origin + start + direction * depth
        })
    }

    /// Largest distance, in texels, between where f32 and f64 put positions in view, for a warp of any strength.
    fn lost(input: &FitInput, strength: f64) -> f64 {
        let texels = Texels::of(SIDE, Pcf::default());
        let body = FocusBody::of_view(&input.camera, &input.scene, TRAVEL, input.origin).unwrap();
        let sight = Sight::of(&input.camera, TRAVEL, &body.vertices, input.origin);
        let frame = sight.frame;
        let bend = Bend::new(&frame, strength / frame.extent);
        let margin = rounding_margin(&body.vertices, input.origin);
        let window = Window::turned(sight.light, bend, frame.axis, &body.vertices, margin);
        let drawn = window.bordered(window.size() / texels.over_window());
        texels_lost(&(drawn.clip_from_ray(-1e3, 1e3) * window.light.ray_from_render()), input)
    }

    fn texels_lost(clip_from_render: &Map<Clip, Render>, input: &FitInput) -> f64 {
        let narrow = clip_from_render.narrow();
        let off = |position: DVec3| {
            let exact = clip_from_render.0 * (position - input.origin).extend(1.0);
            let narrow = narrow * (position - input.origin).as_vec3().extend(1.0);
            let moved = (narrow.truncate().truncate() / narrow.w).as_dvec2() - exact.truncate().truncate() / exact.w;
            0.5 * f64::from(SIDE) * moved.abs().max_element()
        };
        positions(&input.camera).map(off).fold(0.0, f64::max)
    }

    /// What f32 loses by world offset and strength: around the eye, 1/100 of a texel at most at every offset and every
    /// strength up to 1e5, of which fits give those up to 1e3 (limits come first); around the world's origin, many
    /// texels.
    #[test]
    fn what_f32_loses() {
        let strengths = [0.0, 1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6];
        println!("texels of {SIDE} lost; kappa lambda {strengths:?}");
        for around_eye in [true, false] {
            for offset in [0.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7] {
                let input = input(offset, around_eye);
                let lost = strengths.map(|strength| lost(&input, strength));
                let line: Vec<String> = lost.iter().map(|lost| format!("{lost:8.1e}")).collect();
                println!("origin at eye {around_eye:5}, offset {offset:7.0e}: {}", line.join(" "));
                if around_eye {
                    let [served @ .., strongest] = lost;
                    assert!(served.iter().all(|lost| *lost <= 0.01), "offset {offset}: {lost:?}");
                    // Missed here, by a factor of three: a thousand times stronger than any fit is.
                    assert!(strongest <= 0.04, "offset {offset}: {strongest}");
                }
            }
        }
    }

    /// What stops strengths before precision does: the map's border, at this size.
    #[test]
    fn what_limits_strengths() {
        for offset in [0.0, 1e3, 1e7] {
            for (side, applied) in [(256, 24.6), (2048, 203.8), (16_384, 1000.0)] {
                let input = FitInput { map: MapBudget::one(side), ..input(offset, true) };
                let remix = Remix { warp: Warp::Fixed { strength: 1e3 }, ..Remix::default() };
                let frame = remix.fit(&input).unwrap();
                let limited = |cut: &LeftOut| matches!(cut.why, Why::WarpTooStrong { .. });
                println!("offset {offset:e}, {side} texels: {} of 1000", frame.views[0].warp_strength);
                assert!((frame.views[0].warp_strength - applied).abs() < 0.1, "{}", frame.views[0].warp_strength);
                assert_eq!(frame.left_out.iter().any(limited), applied < 1e3);
            }
        }
        let stronger = Remix { warp: Warp::Fixed { strength: 1e6 }, ..Remix::default() };
        assert!(matches!(stronger.fit(&input(0.0, true)), Err(crate::FitError::OutOfRange { .. })));
    }
}
