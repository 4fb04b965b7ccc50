//! A frame with its maps, for lookups at any point and not at pixels alone.

use antumbra::encoding::depth::{CompareMap, DepthMap};
use antumbra::encoding::split::antumbra_visibility;
use antumbra::lab::raster::{DepthMode, DepthTarget, RasterPass, rasterise};
use antumbra::lab::serving::serving;
use antumbra::lab::subject::{Setting, Subject};
use antumbra::{Remix, ShadowFrame, ShadowTechnique, ShadowUniforms, ShadowView};
use glam::{DVec3, UVec2, Vec2};

/// A technique fitted to a setting, drawn.
pub(crate) struct Drawn {
    pub(crate) frame: ShadowFrame,
    setting: Setting,
    maps: Vec<Layer>,
}

impl Drawn {
    pub(crate) fn new(subject: &Subject, setting: &Setting, remix: &Remix, side: u32) -> Self {
        let input = setting.input(subject, &[], remix.wgsl_key(), side);
        let frame = remix.fit(&input).expect("a legal setting");
        let layer = |view| Layer { side, depth: draw(subject, &frame, view, setting.origin) };
        let maps = frame.views.iter().map(layer).collect();
        Self { frame, setting: *setting, maps }
    }

    /// Share of the light that reaches a world point of a surface with this normal.
    pub(crate) fn lit(&self, point: DVec3, normal: DVec3) -> f32 {
        self.lit_by(&self.frame.uniforms, point, normal)
    }

    /// The same with other uniforms for the same maps.
    pub(crate) fn lit_by(&self, uniforms: &ShadowUniforms, point: DVec3, normal: DVec3) -> f32 {
        let Setting { camera, origin, .. } = &self.setting;
        let depth = camera.forward().dot(point - camera.eye()) as f32;
        let (position, normal) = ((point - origin).as_vec3(), normal.as_vec3());
        antumbra_visibility(self.frame.wgsl, uniforms, &self.maps, position, normal, depth)
    }

    /// The view that serves a world point.
    pub(crate) fn serving(&self, point: DVec3, normal: DVec3) -> Option<usize> {
        let Setting { camera, origin, .. } = &self.setting;
        serving(&self.frame, camera, *origin, point - origin, normal)
    }
}

/// A map that owns its texels.
struct Layer {
    side: u32,
    depth: Vec<f32>,
}

impl CompareMap for Layer {
    fn size(&self) -> UVec2 {
        UVec2::splat(self.side)
    }

    fn sample_compare(&self, uv: Vec2, depth: f32) -> f32 {
        DepthMap { size: self.size(), depth: &self.depth }.sample_compare(uv, depth)
    }

    fn depth(&self, texel: Vec2) -> f32 {
        DepthMap { size: self.size(), depth: &self.depth }.depth(texel)
    }
}

fn draw(subject: &Subject, frame: &ShadowFrame, view: &ShadowView, origin: DVec3) -> Vec<f32> {
    let [left, top, width, height] = view.viewport.to_array();
    let mut drawn = DepthTarget::new(width, height, DepthMode::LessEqual);
    let objects = subject.objects.iter().zip(&subject.model.objects);
    let casters = objects.filter(|(object, _)| view.cull.may_cast(&object.bounds)).map(|(_, range)| range.clone());
    let depth_from_render = frame.wgsl.shape.writes_depth().then_some(view.depth_from_render);
    let pass = RasterPass { clip_from_render: view.clip_from_render, depth_from_render, origin };
    rasterise(&mut drawn, &subject.model, &casters.collect::<Vec<_>>(), &pass);
    // At its place in the layer; the rest is cleared.
    let side = frame.map.side as usize;
    let mut map = vec![drawn.mode.cleared(); side * side];
    for (row, depths) in drawn.depth.chunks_exact(width as usize).enumerate() {
        let start = (top as usize + row) * side + left as usize;
        map[start..start + depths.len()].copy_from_slice(depths);
    }
    map
}
