//! The software renderer: z-buffer shadow mapping on the Rust twins of the shaders, for machines without an adapter,
//! and as the check of those with one.
//!
//! # References
//! - S. Bu, J. Bustos, S. L. Tan, *Implementation and assessment of software-based shadow mapping techniques*:
//!   rasterise from the light, look up by projecting each pixel into light space (its equations 1 and 2). Erratum GZ-1:
//!   its constant bias is a threshold, not a low-pass filter; here the bias is the library's own.

use std::time::Instant;

use glam::{DVec3, UVec2, UVec4};
use rayon::prelude::*;

use super::moments::MomentMap;
use super::projection::clip_from_render;
use super::raster::{DepthMode, DepthTarget, Hit, RasterPass, rasterise, resolve};
use super::scene::SceneModel;
use super::subject::{Setting, Subject};
use crate::camera::Camera;
use crate::encoding::depth::{CompareMap, DepthMap};
use crate::encoding::split::antumbra_visibility;
use crate::frame::{ShadowFrame, ShadowView};
use crate::texel::{Moments, Texel};

/// A shadow mask and what it took.
#[derive(Clone, Debug)]
pub struct CpuImage {
    /// Visibility of the light, row 0 on top: 255 lit, 0 in shadow; 255 where there is no geometry.
    pub mask: Vec<u8>,
    /// Time to draw the maps, milliseconds.
    pub casters_ms: f64,
    /// Time to filter them, milliseconds; 0 for maps of depths.
    pub filter_ms: f64,
    /// Time to look every visible point up, milliseconds.
    pub receivers_ms: f64,
}

/// What the camera sees, pixel by pixel: the same for every technique, so it is drawn once.
#[derive(Clone, Debug)]
pub struct Visible {
    hits: Vec<Option<Hit>>,
}

impl Visible {
    /// What pixels show, row by row; those without geometry are passed over.
    pub fn iter(&self) -> impl Iterator<Item = &Hit> {
        self.hits.iter().flatten()
    }

    /// What a pixel shows, if anything; pixels are numbered row by row.
    #[must_use]
    pub fn pixel(&self, index: usize) -> Option<&Hit> {
        self.hits.get(index)?.as_ref()
    }

    /// Draws the scene from the camera at the size of its viewport.
    #[must_use]
    pub fn draw(model: &SceneModel, camera: &Camera, origin: DVec3) -> Self {
        let clip_from_render = clip_from_render(camera, origin);
        let pass = RasterPass { clip_from_render: clip_from_render.as_mat4(), depth_from_render: None, origin };
        let mut target = DepthTarget::new(camera.viewport.x, camera.viewport.y, DepthMode::GreaterEqual);
        rasterise(&mut target, model, &model.objects, &pass);
        Self { hits: resolve(&target, model, &clip_from_render.inverse(), origin) }
    }
}

/// Draws a frame's maps and looks every visible point up in them.
#[must_use]
pub fn render(subject: &Subject, visible: &Visible, frame: &ShadowFrame, setting: &Setting) -> CpuImage {
    if frame.views.is_empty() {
        return CpuImage {
            mask: vec![u8::MAX; visible.hits.len()],
            casters_ms: 0.0,
            filter_ms: 0.0,
            receivers_ms: 0.0,
        };
    }
    // Rasterise from the light.
    let start = Instant::now();
    let mut layers: Vec<Vec<f32>> = Vec::new();
    for view in &frame.views {
        draw(subject, frame, view, setting.origin, &mut layers);
    }
    let casters_ms = start.elapsed().as_secs_f64() * 1e3;
    // Filter them, and project each visible point into the map that serves it.
    let start = Instant::now();
    match frame.wgsl.texel {
        Texel::Depth => {
            let size = UVec2::splat(frame.map.side);
            let maps: Vec<_> = layers.iter().map(|depth| DepthMap { size, depth }).collect();
            let (mask, receivers_ms) = look_up(visible, frame, setting, &maps);
            CpuImage { mask, casters_ms, filter_ms: 0.0, receivers_ms }
        }
        Texel::Moments(moments) => {
            let maps = filtered(moments, frame, &layers);
            let filter_ms = start.elapsed().as_secs_f64() * 1e3;
            let (mask, receivers_ms) = look_up(visible, frame, setting, &maps);
            CpuImage { mask, casters_ms, filter_ms, receivers_ms }
        }
    }
}

/// The layers of a frame as moments.
fn filtered(moments: Moments, frame: &ShadowFrame, layers: &[Vec<f32>]) -> Vec<MomentMap> {
    let mut maps: Vec<_> = layers.iter().map(|_| MomentMap::new(moments, frame.map.side)).collect();
    for view in &frame.views {
        let layer = view.layer as usize;
        maps[layer].filter(&layers[layer], view);
    }
    maps.iter_mut().for_each(MomentMap::halve);
    maps
}

/// The mask, and the time that it took, milliseconds.
fn look_up<M: CompareMap + Sync>(
    visible: &Visible,
    frame: &ShadowFrame,
    setting: &Setting,
    maps: &[M],
) -> (Vec<u8>, f64) {
    let start = Instant::now();
    let lit = |hit: &Option<Hit>| match hit {
        Some(Hit { position, normal, .. }) => {
            let eye_depth = setting.camera.eye_depth(*position, setting.origin) as f32;
            let (position, normal) = (position.as_vec3(), normal.as_vec3());
            antumbra_visibility(frame.wgsl, &frame.uniforms, maps, position, normal, eye_depth)
        }
        None => 1.0,
    };
    let mask = visible.hits.par_iter().map(|hit| (lit(hit) * 255.0).round() as u8).collect();
    (mask, start.elapsed().as_secs_f64() * 1e3)
}

/// One map of a frame: every object that may cast into it. Layers are made as they are wanted.
fn draw(subject: &Subject, frame: &ShadowFrame, view: &ShadowView, origin: DVec3, layers: &mut Vec<Vec<f32>>) {
    let mut drawn = DepthTarget::new(view.viewport.z, view.viewport.w, DepthMode::LessEqual);
    let objects = subject.objects.iter().zip(&subject.model.objects);
    let casters: Vec<_> =
        objects.filter(|(object, _)| view.cull.may_cast(&object.bounds)).map(|(_, range)| range.clone()).collect();
    // Warped maps keep linear depth; it is what z is in affine ones.
    let depth_from_render = frame.wgsl.shape.writes_depth().then_some(view.depth_from_render);
    let pass = RasterPass { clip_from_render: view.clip_from_render, depth_from_render, origin };
    rasterise(&mut drawn, &subject.model, &casters, &pass);
    let (layer, side) = (view.layer as usize, frame.map.side as usize);
    if layers.len() <= layer {
        layers.resize_with(layer + 1, || vec![DepthMode::LessEqual.cleared(); side * side]);
    }
    place(&drawn, view.viewport, side, &mut layers[layer]);
}

/// Puts a view's depths at their place in a layer.
fn place(drawn: &DepthTarget, viewport: UVec4, side: usize, layer: &mut [f32]) {
    let [left, top, width, _] = viewport.to_array().map(|length| length as usize);
    for (row, depths) in drawn.depth.chunks_exact(width).enumerate() {
        let start = (top + row) * side + left;
        layer[start..start + width].copy_from_slice(depths);
    }
}
