//! A small scene on an adapter, and what is drawn and filtered of it.

use antumbra::gpu::{self, ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::gpu::{Gpu, GpuScene, RenderOptions, Renderer, read_depth};
use antumbra::lab::moments::MomentMap;
use antumbra::{
    Camera, DepthSplits, Encoding, FitInput, Light, MapBudget, MomentFormat, MomentKind, Moments, Prefilter, Radius,
    Remix, Scene, ShadowFrame, ShadowTechnique, Share, Split, Texel, WgslKey, techniques,
};
use glam::{DVec3, UVec2};

use crate::support;

/// Size of pictures, pixels.
pub(crate) const SIZE: UVec2 = UVec2::new(160, 120);

/// The boxes on an adapter.
pub(crate) struct Stage {
    pub(crate) gpu: Gpu,
    pub(crate) scene: GpuScene,
}

impl Stage {
    pub(crate) fn new() -> Option<Self> {
        support::gpu().map(Self::on)
    }

    pub(crate) fn on(gpu: Gpu) -> Self {
        let scene = GpuScene::upload(&gpu, &support::boxes(), DVec3::ZERO).unwrap();
        Self { gpu, scene }
    }

    /// The ways to keep moments that its device can draw and read.
    pub(crate) fn supported(&self) -> impl Iterator<Item = Moments> {
        let features = self.gpu.device().features();
        Moments::all().filter(move |moments| features.contains(gpu::required_features(key_of(*moments))))
    }

    /// Maps for a frame.
    pub(crate) fn maps(&self, frame: &ShadowFrame) -> ShadowMaps {
        let descriptor = ShadowMapsDescriptor { label: Some("filter"), key: frame.wgsl, map: frame.map };
        ShadowMaps::new(self.gpu.device(), &descriptor).unwrap()
    }

    /// Draws, filters and reads a frame; the picture.
    pub(crate) fn draw(&self, renderer: &Renderer, frame: &ShadowFrame, maps: &ShadowMaps) -> Vec<u8> {
        let (camera, options) = (support::camera(SIZE), RenderOptions::default());
        renderer.render(&self.gpu, &self.scene, &camera, frame, maps, &options).unwrap().mask
    }

    /// The picture of a technique, with maps and pipelines of its own.
    pub(crate) fn picture(&self, frame: &ShadowFrame) -> Vec<u8> {
        self.draw(&Renderer::new(&self.gpu, frame.wgsl), frame, &self.maps(frame))
    }

    /// What memory makes of the depths that were drawn: a map for each layer.
    pub(crate) fn in_memory(&self, moments: Moments, frame: &ShadowFrame, maps: &ShadowMaps) -> Vec<MomentMap> {
        let depths: Vec<_> = (0..maps.layers()).map(|layer| read_depth(&self.gpu, maps, layer).unwrap()).collect();
        filtered(moments, frame, &depths)
    }
}

/// Layers of depths, filtered in memory.
pub(crate) fn filtered(moments: Moments, frame: &ShadowFrame, depths: &[Vec<f32>]) -> Vec<MomentMap> {
    let mut filtered: Vec<_> = depths.iter().map(|_| MomentMap::new(moments, frame.map.side)).collect();
    for view in &frame.views {
        filtered[view.layer as usize].filter(&depths[view.layer as usize], view);
    }
    filtered.iter_mut().for_each(MomentMap::halve);
    filtered
}

/// The key of one affine map of moments.
pub(crate) fn key_of(moments: Moments) -> WgslKey {
    WgslKey { texel: Texel::Moments(moments), ..WgslKey::default() }
}

/// A frame of the boxes.
pub(crate) fn fit(remix: &Remix, map: MapBudget) -> ShadowFrame {
    fit_to(remix, support::camera(SIZE), map)
}

/// A frame that reads all levels there are, whatever the picture asks for.
pub(crate) fn with_levels(moments: Moments, mut frame: ShadowFrame) -> ShadowFrame {
    let last = moments.last_level(frame.map.side) as f32;
    frame.uniforms.views.iter_mut().for_each(|view| view.moments[1] = last);
    frame
}

/// The same, for a camera.
pub(crate) fn fit_to(remix: &Remix, camera: Camera, map: MapBudget) -> ShadowFrame {
    let scene = Scene::within(support::bounds(&support::boxes()));
    let light = Light::Directional { travel: support::travel() };
    remix.fit(&FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None }).unwrap()
}

/// An encoding of moments.
pub(crate) fn encoding(moments: Moments, radius: Radius, bell: bool) -> Encoding {
    Encoding::Moments(Prefilter { radius, bell, ..Prefilter::of(moments) })
}

/// Six maps of different sizes in two layers of this side.
pub(crate) fn tiled(encoding: Encoding, side: u32) -> (Remix, MapBudget) {
    let splits = DepthSplits { maps: 6, enough: 0.0, ..DepthSplits::DEFAULT };
    let remix = Remix { split: Split::Depth(splits), share: Share::LeastError, encoding, ..techniques::cascades() };
    (remix, MapBudget { side, layers: 2, views: 8 })
}

/// Each kind of moments in the format that it comes in first.
pub(crate) fn kinds() -> impl Iterator<Item = Moments> {
    MomentKind::ALL.into_iter().map(|kind| Moments::new(kind, MomentFormat::Float32))
}
