//! A picture in three passes: casters, the camera's depth, receivers.

use glam::{DVec3, UVec2};

use super::clock::{PassTimes, Stamps, Stopwatch};
use super::pipelines::{self, Pair};
use super::projection::CameraUniforms;
use super::readback::read_layer;
use super::scene::Batch;
use super::{Gpu, GpuFailure, GpuScene};
use crate::camera::Camera;
use crate::frame::{ShadowFrame, ShadowView, WgslKey};
use crate::gpu::{GpuError, ShadowMaps};
use crate::texel::Texel;

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// How often each pass is drawn for its time, the median of which is reported; at least once. One is for pictures;
    /// medians of software drivers settle from about seven on.
    pub repetitions: u32,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self { repetitions: 1 }
    }
}

/// A picture of the visibility of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuImage {
    /// Size, pixels.
    pub size: UVec2,
    /// 255 lit, 0 shadowed, sky 255; row 0 on top.
    pub mask: Vec<u8>,
    /// Times of its passes.
    pub timings: PassTimes,
}

/// The pipelines of one shader key.
#[derive(Debug)]
pub struct Renderer {
    key: WgslKey,
    caster_layout: wgpu::BindGroupLayout,
    casters: Pair,
    depth: Pair,
    receivers: Pair,
}

impl Renderer {
    /// Compiles the pipelines of a key.
    #[must_use]
    pub fn new(gpu: &Gpu, key: WgslKey) -> Self {
        let caster_layout = caster_layout(gpu);
        Self {
            key,
            casters: pipelines::casters(gpu, key.shape, &caster_layout, None),
            depth: pipelines::camera_depth(gpu),
            receivers: pipelines::receivers(gpu, key),
            caster_layout,
        }
    }

    /// The same, whose maps hold back faces alone: casters with `cull_mode: Some(Face::Front)`, counter-clockwise front
    /// faces. Closed solids need no bias on their lit sides then; ground and leaves cast nothing, or half.
    #[must_use]
    pub fn of_back_faces(gpu: &Gpu, key: WgslKey) -> Self {
        let renderer = Self::new(gpu, key);
        let casters = pipelines::casters(gpu, key.shape, &renderer.caster_layout, Some(wgpu::Face::Front));
        Self { casters, ..renderer }
    }

    /// The same for a key with [`Pcf::Box5x5`](crate::Pcf::Box5x5), whose box is made `taps` bilinear taps to an axis
    /// wide, 2 `taps` − 1 texels: the yardstick of wide filters, as an engine writes it. Other keys stay as they are.
    #[must_use]
    pub fn with_box(gpu: &Gpu, key: WgslKey, taps: u32) -> Self {
        let renderer = Self::new(gpu, key);
        if key.filter != crate::frame::Pcf::Box5x5 {
            return renderer;
        }
        Self { receivers: pipelines::wide_receivers(gpu, key, taps), ..renderer }
    }

    /// The key it was compiled for.
    #[must_use]
    pub fn key(&self) -> WgslKey {
        self.key
    }

    /// Draws casters into the maps and the camera's picture of them, and times both.
    ///
    /// # Errors
    /// Frame, maps, scene and renderer do not fit together, or the device failed.
    pub fn render(
        &self,
        gpu: &Gpu,
        scene: &GpuScene,
        camera: &Camera,
        frame: &ShadowFrame,
        maps: &ShadowMaps,
        options: &RenderOptions,
    ) -> Result<GpuImage, GpuFailure> {
        // Upload, and draw the camera's depth.
        let shot = Shot::new(self, gpu, scene, camera, frame, maps)?;
        let stopwatch = Stopwatch::new(gpu);
        stopwatch.time(|encoder, _| shot.depth_pass(encoder))?;
        // Draw the passes that are timed, in turns.
        let times = (0..options.repetitions.max(1)).map(|_| shot.turn(&stopwatch)).collect::<Result<Vec<_>, _>>()?;
        let timings = PassTimes::median(&times, stopwatch.clock());
        Ok(GpuImage { size: camera.viewport, mask: shot.read_mask()?, timings })
    }
}

/// One picture in the making: targets, uploads, and what is drawn in each pass.
pub(super) struct Shot<'a> {
    gpu: &'a Gpu,
    renderer: &'a Renderer,
    pub(super) scene: &'a GpuScene,
    frame: &'a ShadowFrame,
    maps: &'a ShadowMaps,
    size: UVec2,
    camera: wgpu::BindGroup,
    depth: wgpu::TextureView,
    mask: wgpu::Texture,
    /// Casters of each view.
    pub(super) casters: Vec<Vec<Batch<'a>>>,
    everything: Vec<Batch<'a>>,
}

impl<'a> Shot<'a> {
    /// Checks that everything fits together, and uploads.
    pub(super) fn new(
        renderer: &'a Renderer,
        gpu: &'a Gpu,
        scene: &'a GpuScene,
        camera: &Camera,
        frame: &'a ShadowFrame,
        maps: &'a ShadowMaps,
    ) -> Result<Self, GpuFailure> {
        // Refuse what does not fit.
        if renderer.key != frame.wgsl {
            return Err(GpuError::Key { expected: renderer.key, actual: frame.wgsl }.into());
        }
        check_origin(scene, frame)?;
        let size = camera.viewport;
        let (side, largest) = (size.max_element(), gpu.device().limits().max_texture_dimension_2d);
        if side > largest {
            return Err(GpuFailure::Picture { side, largest });
        }
        // Upload the frame and the camera.
        maps.prepare(gpu.queue(), frame)?;
        let uniforms = CameraUniforms::of(camera, scene.origin());
        let uniforms = pipelines::uniform_buffer(gpu, "camera", bytemuck::bytes_of(&uniforms));
        let camera = gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("camera"),
            layout: &pipelines::camera_layout(gpu.device()),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
        });
        // Make the targets, and choose what is drawn.
        let depth = target(gpu, size, crate::gpu::DEPTH_FORMAT).create_view(&wgpu::TextureViewDescriptor::default());
        let mask = target(gpu, size, pipelines::MASK_FORMAT);
        let casters =
            frame.views.iter().map(|view| scene.batches(|bounds| view.cull.may_cast(bounds))).collect::<Vec<_>>();
        let everything = scene.batches(|_| true);
        Ok(Self { gpu, renderer, scene, frame, maps, size, camera, depth, mask, casters, everything })
    }

    /// The views of its frame.
    pub(super) fn views(&self) -> &'a [ShadowView] {
        &self.frame.views
    }

    /// Draws every pass once, and times each.
    pub(super) fn turn(&self, stopwatch: &Stopwatch) -> Result<PassTimes, GpuFailure> {
        let any = !self.frame.views.is_empty();
        let casters = stopwatch.time(|encoder, stamps| self.caster_passes(encoder, stamps))?;
        let filter_ms = if any && self.renderer.key.texel != Texel::Depth {
            stopwatch.time(|encoder, stamps| self.filter_passes(encoder, stamps))?
        } else {
            0.0
        };
        let (pair, group) = (&self.renderer.receivers, self.maps.bind_group());
        let receivers_ms = stopwatch.time(|encoder, stamps| self.receiver_pass(encoder, stamps, pair, group))?;
        let casters_ms = if any { casters } else { 0.0 };
        Ok(PassTimes { casters_ms, filter_ms, receivers_ms, clock: stopwatch.clock() })
    }

    /// Draws the casters of every view.
    pub(super) fn caster_passes(&self, encoder: &mut wgpu::CommandEncoder, stamps: Stamps) {
        let count = self.frame.views.len();
        for (index, (view, batches)) in self.frame.views.iter().zip(&self.casters).enumerate() {
            let mut pass = self.maps.caster_pass(encoder, view, stamps.of_pass(index, count));
            pass.set_bind_group(0, self.maps.caster_bind_group(), &[self.maps.caster_offset(index)]);
            self.scene.draw(&mut pass, batches, &self.renderer.casters);
        }
    }

    /// Filters the maps.
    pub(super) fn filter_passes(&self, encoder: &mut wgpu::CommandEncoder, stamps: Stamps) {
        self.maps.filter(encoder, self.frame, &mut |index, count| stamps.of_pass(index, count));
    }

    /// Draws the camera's depth.
    pub(super) fn depth_pass(&self, encoder: &mut wgpu::CommandEncoder) {
        let load = wgpu::LoadOp::Clear(0.0);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("camera depth"),
            depth_stencil_attachment: Some(self.depth_attachment(load)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.camera, &[]);
        self.scene.draw(&mut pass, &self.everything, &self.renderer.depth);
    }

    /// Draws receivers over the depth that is there.
    pub(super) fn receiver_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        stamps: Stamps,
        pipelines: &Pair,
        group: &wgpu::BindGroup,
    ) {
        let view = self.mask.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("receivers"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::WHITE), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(self.depth_attachment(wgpu::LoadOp::Load)),
            timestamp_writes: stamps.of_pass(0, 1),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.camera, &[]);
        pass.set_bind_group(1, group, &[]);
        self.scene.draw(&mut pass, &self.everything, pipelines);
    }

    fn depth_attachment(&self, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }
    }

    /// The picture, row 0 on top.
    pub(super) fn read_mask(&self) -> Result<Vec<u8>, GpuFailure> {
        read_layer(self.gpu, &self.mask, 0, self.size, 1)
    }
}

impl Renderer {
    /// Layout of a caster's matrix, as the maps make it.
    pub(super) fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.caster_layout
    }

    /// Its pass over receivers.
    pub(super) fn receivers(&self) -> &Pair {
        &self.receivers
    }
}

/// Every view of a frame knows the origin it was fitted with.
fn check_origin(scene: &GpuScene, frame: &ShadowFrame) -> Result<(), GpuFailure> {
    let differs = |origin: &DVec3| *origin != scene.origin();
    match frame.views.iter().map(|view| view.cull.origin).find(differs) {
        Some(origin) => Err(GpuFailure::Origin { scene: scene.origin(), frame: origin }),
        None => Ok(()),
    }
}

/// The layout that [`ShadowMaps`] gives its casters.
fn caster_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    crate::gpu::caster_layout(gpu.device())
}

fn target(gpu: &Gpu, size: UVec2, format: wgpu::TextureFormat) -> wgpu::Texture {
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}
