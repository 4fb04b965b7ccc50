//! The blur of a picture's shadow term: two passes an iteration, along rows and along columns.
//!
//! All of it runs on any adapter of WebGPU: render passes, loads, no storage textures. In between the term is kept in
//! 32-bit floats: adapters may cut what they store in 16 bits, which darkens by up to 1.5 % in 16 iterations.

use core::num::NonZeroU64;

use glam::{DMat4, UVec2};

use crate::encoding::eye_blur::{EyeBlur, EyeBlurUniforms, MOST_ITERATIONS};
use crate::error::FitError;

/// Format in which the term is kept between passes: what every adapter draws, in one channel, and rounds to nothing
/// that shows.
const BETWEEN: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// Blurs the shadow term of pictures of one size: [`EyeBlur`] says how wide.
///
/// The engine draws its shadow term (what `antumbra_visibility` gives) into a texture of its own, and its depth buffer
/// before; both without multisampling and with `TEXTURE_BINDING`. Then, where it lights its picture, it reads the
/// blurred term instead.
#[derive(Debug)]
pub struct ScreenBlur {
    size: UVec2,
    layout: wgpu::BindGroupLayout,
    along_row: wgpu::RenderPipeline,
    along_column: wgpu::RenderPipeline,
    last: wgpu::RenderPipeline,
    between: [wgpu::TextureView; 2],
    uniforms: wgpu::Buffer,
}

/// The pictures of a blur.
#[derive(Clone, Copy, Debug)]
pub struct ScreenBlurViews<'a> {
    /// The shadow term, in the first channel of any format that is read as floats, filterable or not.
    pub source: &'a wgpu::TextureView,
    /// The depth buffer of the same pixels, in any depth convention.
    pub depth: &'a wgpu::TextureView,
    /// Where the blurred term is drawn: another texture than `source`, with `RENDER_ATTACHMENT`.
    pub target: &'a wgpu::TextureView,
}

impl ScreenBlur {
    /// Makes pipelines for targets of `format` (a colour format that adapters draw into, [`R8Unorm`] as a rule), and
    /// textures of `size` pixels, at least one along each side.
    ///
    /// [`R8Unorm`]: wgpu::TextureFormat::R8Unorm
    #[must_use]
    pub fn new(device: &wgpu::Device, size: UVec2, format: wgpu::TextureFormat) -> Self {
        let label = Some("antumbra eye blur");
        let source = wgpu::ShaderSource::Wgsl(crate::wgsl::EYE_BLUR.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let layout = layout(device);
        let pipeline = |entry, format| pipeline(device, &module, &layout, entry, format);
        let between = || {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label,
                size: wgpu::Extent3d { width: size.x.max(1), height: size.y.max(1), depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: BETWEEN,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self {
            size,
            along_row: pipeline("antumbra_eye_blur_along_row", BETWEEN),
            along_column: pipeline("antumbra_eye_blur_along_column", BETWEEN),
            last: pipeline("antumbra_eye_blur_along_column", format),
            between: [between(), between()],
            uniforms: device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size: size_of::<EyeBlurUniforms>() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            layout,
        }
    }

    /// Uploads how wide the blur is under a camera of that projection: before the submission of its passes.
    ///
    /// # Errors
    /// As [`EyeBlur::uniforms`].
    pub fn prepare(&self, queue: &wgpu::Queue, blur: &EyeBlur, clip_from_view: &DMat4) -> Result<(), FitError> {
        let uniforms = blur.uniforms(clip_from_view, self.size)?;
        queue.write_buffer(&self.uniforms, 0, bytemuck::bytes_of(&uniforms));
        Ok(())
    }

    /// Records two passes for each of `blur.iterations` (1 to 16; what is given beyond is taken for the nearer end).
    /// Everything else of it is as it was at [`prepare`](Self::prepare). `stamps` gives the timestamps of a pass, by
    /// its number and their count.
    pub fn blur<'a>(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        views: &ScreenBlurViews,
        blur: &EyeBlur,
        stamps: &mut dyn FnMut(usize, usize) -> Option<wgpu::RenderPassTimestampWrites<'a>>,
    ) {
        let [across, down] = &self.between;
        let [source, across_group, down_group] =
            [views.source, across, down].map(|view| self.group(device, view, views.depth));
        let last = blur.iterations.clamp(1, MOST_ITERATIONS) - 1;
        let count = 2 * (last as usize + 1);
        for iteration in 0..=last {
            let first = 2 * iteration as usize;
            let read = if iteration == 0 { &source } else { &down_group };
            record(encoder, &self.along_row, read, across, stamps(first, count));
            let (pipeline, target) =
                if iteration == last { (&self.last, views.target) } else { (&self.along_column, down) };
            record(encoder, pipeline, &across_group, target, stamps(first + 1, count));
        }
    }

    fn group(&self, device: &wgpu::Device, term: &wgpu::TextureView, depth: &wgpu::TextureView) -> wgpu::BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("antumbra eye blur"),
            layout: &self.layout,
            entries: &[
                entry(0, self.uniforms.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(term)),
                entry(2, wgpu::BindingResource::TextureView(depth)),
            ],
        })
    }
}

/// One triangle over everything.
fn record(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    group: &wgpu::BindGroup,
    view: &wgpu::TextureView,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites>,
) {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::WHITE), store: wgpu::StoreOp::Store };
    let attachment = wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("antumbra eye blur"),
        color_attachments: &[Some(attachment)],
        timestamp_writes,
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..3, 0..1);
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let texture = |sample_type| wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let uniforms = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(size_of::<EyeBlurUniforms>() as u64),
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("antumbra eye blur"),
        entries: &[
            entry(0, uniforms),
            entry(1, texture(wgpu::TextureSampleType::Float { filterable: false })),
            entry(2, texture(wgpu::TextureSampleType::Depth)),
        ],
    })
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    entry: &str,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let label = Some(entry);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label,
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("antumbra_everything"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: label,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}
