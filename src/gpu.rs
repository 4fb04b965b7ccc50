//! Feature `wgpu`: the textures, bind groups and passes of one light's shadow maps.
//!
//! Middleware: the device, the queue, the encoder and every submission belong to the engine. Nothing here creates a
//! device, submits, polls or waits, and after [`ShadowMaps::new`] nothing allocates beyond what wgpu does when it is
//! told to upload and to begin a pass.
//!
//! The map keeps its own depth convention (0 nearest to the light), so it serves engines with reversed depth unchanged.
//!
//! ```no_run
//! use antumbra::gpu::{self, ShadowMaps, ShadowMapsDescriptor, wgpu};
//! use antumbra::{FitInput, ShadowTechnique, wgsl};
//!
//! # type Failure = Box<dyn std::error::Error>;
//! # fn engine(device: &wgpu::Device, queue: &wgpu::Queue, technique: &dyn ShadowTechnique, input: &FitInput,
//! #     casters: &wgpu::RenderPipeline, draw: &dyn Fn(&mut wgpu::RenderPass)) -> Result<(), Failure> {
//! // When options change: maps, and the text that goes in front of the lighting shader.
//! let key = technique.wgsl_key();
//! let maps = ShadowMaps::new(device, &ShadowMapsDescriptor { label: Some("sun"), key, map: input.map })?;
//! let lighting = wgsl::module(key, wgsl::Bindings { group: 2, first: 0 }); // + the engine's own text
//! // Every frame: fit, upload, draw casters.
//! let frame = technique.fit(input)?;
//! maps.prepare(queue, &frame)?;
//! let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
//! for (index, view) in frame.views.iter().enumerate() {
//!     let mut pass = maps.caster_pass(&mut encoder, view, None);
//!     pass.set_pipeline(casters); // built with `gpu::depth_stencil_state()` and `maps.caster_layout()`
//!     pass.set_bind_group(0, maps.caster_bind_group(), &[maps.caster_offset(index)]);
//!     draw(&mut pass); // the objects for which `view.cull.may_cast` holds
//! }
//! maps.filter(&mut encoder, &frame, &mut |_, _| None); // maps of moments; nothing for maps of depths
//! // In the engine's own pass: `pass.set_bind_group(2, maps.bind_group(), &[])`.
//! queue.submit([encoder.finish()]);
//! # let _ = lighting; Ok(())
//! # }
//! ```
//!
//! The casters' pipeline is the engine's own, with [`wgsl::CASTER`](crate::wgsl::CASTER) in its shader. Casters of
//! uniform maps ([`MapShape::Affine`](crate::MapShape::Affine)) need no fragment shader. Casters of warped maps
//! ([`MapShape::Projective`](crate::MapShape::Projective)) carry their linear depth from vertices to fragments, which
//! write it:
//!
//! ```wgsl
//! struct View { clip_from_render: mat4x4f, depth_from_render: vec4f }
//! @group(0) @binding(0) var<uniform> view: View; // `maps.caster_bind_group()`
//! struct Caster { @builtin(position) clip: vec4f, @location(0) depth: f32 }
//!
//! @vertex fn cast(@location(0) position: vec3f) -> Caster { // `position` in render space
//!     let clip = antumbra_caster(view.clip_from_render, position);
//!     return Caster(clip, antumbra_caster_depth(view.depth_from_render, position));
//! }
//!
//! @fragment fn write_depth(caster: Caster) -> @builtin(frag_depth) f32 {
//!     return caster.depth;
//! }
//! ```

mod clear;
mod depth_range;
mod error;
mod eye_blur;
mod layout;
mod prefilter;
mod resources;

use arrayvec::ArrayVec;

pub use self::{depth_range::DepthRangeProbe, error::GpuError, eye_blur::ScreenBlur, eye_blur::ScreenBlurViews};
pub use layout::{caster_layout, layout_entries};
pub use prefilter::{supported, texture_format};
pub use wgpu;

use crate::frame::{MAX_VIEWS, ShadowFrame, ShadowView, WgslKey};
use crate::scene::MapBudget;
use crate::texel::Texel;
use clear::{TileClear, limit_to, tile_of};
use layout::{CASTER_BYTES, bind_entries, caster_bind_group, map_dimension, most_views, uniform_bytes};
use prefilter::Prefilter;
use resources::{attachment, depth_texture, lit_uniforms, sampler};

/// Format of a depth map: the precision that the bias is computed for.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Bytes of a texel of [`DEPTH_FORMAT`].
const DEPTH_TEXEL_BYTES: u64 = 4;

/// What [`ShadowMaps::new`] makes.
#[derive(Clone, Copy, Debug)]
pub struct ShadowMapsDescriptor<'a> {
    /// Name in graphics debuggers.
    pub label: Option<&'a str>,
    /// The shader text that will read the maps.
    pub key: WgslKey,
    /// The texels: a layer for each map of the key, and no more of them than the budget has layers and views. A key for
    /// one map uses one layer and one view, whatever the budget allows.
    pub map: MapBudget,
}

/// The maps of one light, and everything that reads and writes them.
#[derive(Debug)]
pub struct ShadowMaps {
    key: WgslKey,
    side: u32,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// For maps of moments.
    prefilter: Option<Prefilter>,
    /// What casters are drawn into: a view for each layer.
    attachments: ArrayVec<wgpu::TextureView, MAX_VIEWS>,
    /// For maps that share a layer; one map has its own.
    clear: Option<TileClear>,
    compare: wgpu::Sampler,
    uniforms: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    casters: wgpu::Buffer,
    caster_stride: u32,
    caster_layout: wgpu::BindGroupLayout,
    caster_bind_group: wgpu::BindGroup,
}

impl ShadowMaps {
    /// Makes the maps and their bind groups. Until the first [`prepare`](Self::prepare) everything reads lit.
    ///
    /// # Errors
    /// [`GpuError::Side`] when the device cannot hold a map of that side.
    pub fn new(device: &wgpu::Device, descriptor: &ShadowMapsDescriptor) -> Result<Self, GpuError> {
        let ShadowMapsDescriptor { label, key, map } = *descriptor;
        let largest = device.limits().max_texture_dimension_2d;
        if !(1..=largest).contains(&map.side) {
            return Err(GpuError::Side { side: map.side, largest });
        }
        // The maps, and the sampler that compares with them.
        let layers = layers(key, map);
        let texture = depth_texture(device, label, map.side, layers);
        let dimension = map_dimension(key);
        let prefilter = match key.texel {
            Texel::Depth => None,
            Texel::Moments(moments) => Some(Prefilter::new(device, label, moments, &texture, dimension)),
        };
        let view = match &prefilter {
            Some(prefilter) => prefilter.view().clone(),
            None => texture.create_view(&wgpu::TextureViewDescriptor {
                label,
                dimension: Some(dimension),
                ..Default::default()
            }),
        };
        let attachments = (0..layers).map(|layer| attachment(&texture, label, layer)).collect();
        let compare = device.create_sampler(&sampler(label, key));
        // What receivers read.
        let uniforms = lit_uniforms(device, label);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label,
            entries: &layout_entries(key, 0, wgpu::ShaderStages::VERTEX_FRAGMENT),
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label,
            layout: &layout,
            entries: &bind_entries(key, 0, &uniforms, &view, &compare),
        });
        // What casters read: one matrix per view, at dynamic offsets.
        let caster_stride = (CASTER_BYTES as u32).next_multiple_of(device.limits().min_uniform_buffer_offset_alignment);
        let casters = device.create_buffer(&wgpu::BufferDescriptor {
            label,
            size: u64::from(caster_stride) * most_views(key) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let caster_layout = caster_layout(device);
        let caster_bind_group = caster_bind_group(device, label, &caster_layout, &casters);
        Ok(Self {
            key,
            side: map.side,
            texture,
            view,
            prefilter,
            attachments,
            clear: (key.maps > 1).then(|| TileClear::new(device)),
            compare,
            uniforms,
            layout,
            bind_group,
            casters,
            caster_stride,
            caster_layout,
            caster_bind_group,
        })
    }

    /// Uploads a frame: the uniforms of all maps that the key's shader reads (208 bytes each), and each view's matrix.
    ///
    /// A frame may have fewer views than its key has maps: the others read lit, and their layers need not be drawn.
    /// That of a frame without views is "everything is lit".
    ///
    /// # Errors
    /// The frame does not fit these maps; nothing was uploaded.
    pub fn prepare(&self, queue: &wgpu::Queue, frame: &ShadowFrame) -> Result<(), GpuError> {
        // Refuse what the maps were not made for.
        if frame.wgsl != self.key {
            return Err(GpuError::Key { expected: self.key, actual: frame.wgsl });
        }
        let (views, most) = (frame.views.len(), most_views(self.key));
        if views > 0 && frame.map.side != self.side {
            return Err(GpuError::FrameSide { side: frame.map.side, expected: self.side });
        }
        if views > most {
            return Err(GpuError::Views { views, most });
        }
        for (index, view) in frame.views.iter().enumerate() {
            self.check_viewport(index, view)?;
        }
        // Upload.
        let bytes = bytemuck::bytes_of(&frame.uniforms);
        queue.write_buffer(&self.uniforms, 0, &bytes[..uniform_bytes(self.key) as usize]);
        for (index, view) in frame.views.iter().enumerate() {
            let offset = u64::from(self.caster_offset(index));
            let mut caster = [0.0; CASTER_BYTES as usize / size_of::<f32>()];
            caster[..16].copy_from_slice(&view.clip_from_render.to_cols_array());
            caster[16..].copy_from_slice(&view.depth_from_render.to_array());
            queue.write_buffer(&self.casters, offset, bytemuck::bytes_of(&caster));
        }
        if let Some(prefilter) = &self.prefilter {
            prefilter.prepare(queue, frame);
        }
        Ok(())
    }

    /// Filters the maps of a frame, for keys that store moments: two passes a view, and one for each level of the mip
    /// chain. Call it when all casters are drawn. Nothing is recorded for maps of depths, and for frames without views.
    ///
    /// `stamps` gives the timestamps of each pass, by its number and their count.
    pub fn filter<'stamps>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame,
        stamps: &mut dyn FnMut(usize, usize) -> Option<wgpu::RenderPassTimestampWrites<'stamps>>,
    ) {
        if let Some(prefilter) = &self.prefilter {
            prefilter.run(encoder, frame, stamps);
        }
    }

    fn check_viewport(&self, index: usize, view: &ShadowView) -> Result<(), GpuError> {
        let at = view.viewport;
        let inside = |start: u32, length: u32| start.checked_add(length).is_some_and(|end| end <= self.side);
        let layers = self.layers();
        if view.layer < layers && inside(at.x, at.z) && inside(at.y, at.w) {
            return Ok(());
        }
        Err(GpuError::Viewport { view: index, viewport: at, layer: view.layer, side: self.side, layers })
    }

    /// Begins the depth pass of a view: its tile of the layer cleared to the farthest depth, its viewport set; what
    /// other views have in the layer stays. The engine binds, and draws. Layers beyond the last that the maps have,
    /// which [`prepare`](Self::prepare) refuses, are the last one.
    pub fn caster_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        view: &ShadowView,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites>,
    ) -> wgpu::RenderPass<'encoder> {
        let layer = (view.layer as usize).min(self.attachments.len() - 1);
        let tile = tile_of(view.viewport, self.side);
        let shared = self.clear.as_ref().filter(|_| tile.z < self.side || tile.w < self.side);
        let load = if shared.is_some() { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(1.0) };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("antumbra casters"),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.attachments[layer],
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        if let Some(clear) = shared {
            clear.draw(&mut pass, tile);
        }
        // What lies outside has to stay clear: lookups beyond the view read lit there.
        limit_to(&mut pass, view.viewport);
        pass
    }

    /// The key that these maps were made for: pipelines that read them need [`wgsl::module`](crate::wgsl::module) of
    /// it.
    #[must_use]
    pub fn key(&self) -> WgslKey {
        self.key
    }

    /// Layout of [`bind_group`](Self::bind_group): three bindings from 0 on, visible to vertex and
    /// fragment shaders.
    /// Engines that merge groups take [`layout_entries`] and [`bind_entries`](Self::bind_entries) instead.
    #[must_use]
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// What the receivers' functions read, in vertex and fragment stages, for shader text made with `Bindings { group,
    /// first: 0 }`.
    #[must_use]
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// The entries that match [`layout_entries`], for a bind group of the engine's own.
    #[must_use]
    pub fn bind_entries(&self, first: u32) -> [wgpu::BindGroupEntry<'_>; 3] {
        bind_entries(self.key, first, &self.uniforms, &self.view, &self.compare)
    }

    /// Layout of [`caster_bind_group`](Self::caster_bind_group): binding 0 at a dynamic offset, visible to vertex
    /// shaders: `clip_from_render: mat4x4f`, and after it, for warped maps, `depth_from_render: vec4f`.
    #[must_use]
    pub fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.caster_layout
    }

    /// The views' matrices and depth rows, for engines that do not bring their own.
    #[must_use]
    pub fn caster_bind_group(&self) -> &wgpu::BindGroup {
        &self.caster_bind_group
    }

    /// The dynamic offset of a view's matrix in [`caster_bind_group`](Self::caster_bind_group). Views beyond the last
    /// that the maps hold get the last one's.
    #[must_use]
    pub fn caster_offset(&self, view: usize) -> u32 {
        self.caster_stride * view.min(most_views(self.key) - 1) as u32
    }

    /// The maps: a layer for each, or tiles of layers ([`ShadowView::layer`], [`ShadowView::viewport`]).
    #[must_use]
    pub fn depth_texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// The filtered maps with all levels, for keys that store moments.
    #[must_use]
    pub fn moments_texture(&self) -> Option<&wgpu::Texture> {
        self.prefilter.as_ref().map(Prefilter::texture)
    }

    /// What shaders read: a `texture_depth_2d`, or a `texture_depth_2d_array` for keys of several maps; the filtered
    /// maps for keys that store moments.
    #[must_use]
    pub fn map_view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Number of layers: of whole maps that there are texels for.
    #[must_use]
    pub fn layers(&self) -> u32 {
        self.attachments.len() as u32
    }

    /// Memory of the maps, bytes, whether their texels are in use or not (texels only: what drivers add is not known
    /// here).
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let depths = u64::from(self.side) * u64::from(self.side) * u64::from(self.layers()) * DEPTH_TEXEL_BYTES;
        depths + self.prefilter.as_ref().map_or(0, Prefilter::bytes)
    }
}

/// Features that the maps of a key need from the device: none for depths, and for moments what their format needs;
/// [`supported`] chooses one that a device has.
#[must_use]
pub fn required_features(key: WgslKey) -> wgpu::Features {
    match key.texel {
        Texel::Depth => wgpu::Features::empty(),
        Texel::Moments(moments) => prefilter::required_features(moments),
    }
}

/// How casters are written: nearest wins, no hardware bias (the receiver's bias is exact, and a second one would only
/// detach shadows).
#[must_use]
pub fn depth_stencil_state() -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::LessEqual),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// Layers of the maps: never none, for a shader has to read something.
fn layers(key: WgslKey, map: MapBudget) -> u32 {
    (most_views(key) as u32).min(map.layers).min(map.views).max(1)
}
