//! The passes that make a map of moments out of a map of depths.
//!
//! Two passes a view, along u and along v, each a triangle over the view's tile: nothing outside of it is read or
//! written. Then the mip chain, four texels at a time. All of it runs on any adapter of WebGPU: render passes, loads,
//! no storage textures.
//! Summed-area tables have passes of their own ([`sums`]).

mod sums;

use core::num::NonZeroU64;

use arrayvec::ArrayVec;

use crate::frame::{MAX_VIEWS, ShadowFrame};
use crate::texel::{BlurUniforms, MomentFormat, Moments, SUMMED_TEXELS};
use sums::sums;

/// Features that an adapter has to have for a format, beyond what every adapter has.
#[must_use]
pub(super) fn required_features(moments: Moments) -> wgpu::Features {
    let exact = match moments.format() {
        // The second is what lets them be drawn into.
        MomentFormat::Unorm16 => {
            wgpu::Features::TEXTURE_FORMAT_16BIT_NORM | wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
        }
        _ => wgpu::Features::empty(),
    };
    let linear = match moments.format() {
        MomentFormat::Float32 if moments.linear => wgpu::Features::FLOAT32_FILTERABLE,
        _ => wgpu::Features::empty(),
    };
    exact | linear
}

/// The most exact way to keep moments that an adapter with these features has; with none of them, 32 bits that the
/// shader interpolates.
#[must_use]
pub fn supported(wanted: Moments, features: wgpu::Features) -> Moments {
    let linear = |format| format != MomentFormat::Float32 || features.contains(wgpu::Features::FLOAT32_FILTERABLE);
    let in_format = |format| {
        let moments = Moments::new(wanted.kind(), format);
        let (linear, mips) = (linear(moments.format()), wanted.mips);
        moments.read(linear, mips)
    };
    let asked = in_format(wanted.format());
    let has = |moments: &Moments| features.contains(required_features(*moments));
    let others = wanted.kind().formats().iter().map(|format| in_format(*format));
    core::iter::once(asked).chain(others).find(has).unwrap_or(asked)
}

/// The texture format of moments.
#[must_use]
pub fn texture_format(moments: Moments) -> wgpu::TextureFormat {
    use wgpu::TextureFormat as Format;
    match (moments.kind().channels(), moments.format()) {
        (1, MomentFormat::Float16) => Format::R16Float,
        (1, _) => Format::R32Float,
        (2, MomentFormat::Float16) => Format::Rg16Float,
        (2, MomentFormat::Unorm16) => Format::Rg16Unorm,
        (2, MomentFormat::Summed) => Format::Rg32Uint,
        (2, _) => Format::Rg32Float,
        (_, MomentFormat::Float16) => Format::Rgba16Float,
        (_, MomentFormat::Unorm16) => Format::Rgba16Unorm,
        (_, MomentFormat::Unorm8) => Format::Rgba8Unorm,
        (_, MomentFormat::Summed) => Format::Rgba32Uint,
        (_, MomentFormat::Float32) => Format::Rgba32Float,
    }
}

/// What shaders read of moments.
pub(super) fn stored_type(moments: Moments) -> wgpu::TextureSampleType {
    if moments.is_summed() {
        wgpu::TextureSampleType::Uint
    } else {
        wgpu::TextureSampleType::Float { filterable: moments.linear }
    }
}

/// The maps of moments of one light, and the passes that fill them.
#[derive(Debug)]
pub(super) struct Prefilter {
    moments: Moments,
    side: u32,
    maps: wgpu::Texture,
    view: wgpu::TextureView,
    /// From depths, along u.
    along_u: wgpu::RenderPipeline,
    along_v: wgpu::RenderPipeline,
    /// From a level of mips to the next one; of sums, further along u.
    further: wgpu::RenderPipeline,
    uniforms: wgpu::Buffer,
    stride: u32,
    /// Uniform blocks of a view: one for each pair of terms of a series, or for each pass of sums along an axis.
    blocks: u32,
    /// Depths of each layer, to be read along u.
    depths: Vec<wgpu::BindGroup>,
    /// What was averaged along u: one layer for all of them, one after the other.
    scratch: wgpu::TextureView,
    scratch_group: wgpu::BindGroup,
    /// Each level of each layer, to be drawn into and, but for the last level, to be read.
    levels: Vec<Vec<(wgpu::TextureView, wgpu::BindGroup)>>,
}

impl Prefilter {
    pub(super) fn new(
        device: &wgpu::Device,
        label: Option<&str>,
        moments: Moments,
        depth: &wgpu::Texture,
        dimension: wgpu::TextureViewDimension,
    ) -> Self {
        let (side, layers) = (depth.width(), depth.depth_or_array_layers());
        let format = texture_format(moments);
        // Pipelines.
        let layouts = Layouts::new(device, moments);
        let source = wgpu::ShaderSource::Wgsl(crate::wgsl::prefilter(moments).into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let pipeline = |entry, layout: &wgpu::BindGroupLayout| pass_pipeline(device, &module, entry, layout, format);
        // Textures.
        let level_count = moments.last_level(side) + 1;
        let texture = |layers, levels| target(device, label, side, layers, levels, format);
        let maps = texture(layers * moments.layers(), level_count);
        let scratch = texture(1, 1).create_view(&wgpu::TextureViewDescriptor::default());
        let view = maps.create_view(&wgpu::TextureViewDescriptor { dimension: Some(dimension), ..Default::default() });
        // Uniforms, and what each pass reads.
        let block = size_of::<BlurUniforms>() as u64;
        let blocks = if moments.is_summed() { sums(side) } else { moments.layers() };
        let stride = (block as u32).next_multiple_of(device.limits().min_uniform_buffer_offset_alignment);
        let uniforms = device.create_buffer(&wgpu::BufferDescriptor {
            label,
            size: u64::from(stride * blocks) * MAX_VIEWS as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = |layout: &wgpu::BindGroupLayout, binding, view: &wgpu::TextureView| {
            let buffer = wgpu::BufferBinding { buffer: &uniforms, offset: 0, size: NonZeroU64::new(block) };
            let entries = [
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(buffer) },
                wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) },
            ];
            device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries: &entries })
        };
        let depths = (0..layers).map(|layer| group(&layouts.depths, 1, &one(depth, layer, 0))).collect();
        let of_level = |layer, level| {
            let view = one(&maps, layer, level);
            let group = group(&layouts.stored, 2, &view);
            (view, group)
        };
        let of_layer = |layer| (0..level_count).map(|level| of_level(layer, level)).collect();
        let [along_u, along_v, further] = entries(moments);
        Self {
            along_u: pipeline(along_u, &layouts.depths),
            along_v: pipeline(along_v, &layouts.stored),
            further: pipeline(further, &layouts.stored),
            scratch_group: group(&layouts.stored, 2, &scratch),
            levels: (0..layers * moments.layers()).map(of_layer).collect(),
            moments,
            side,
            maps,
            view,
            uniforms,
            stride,
            blocks,
            depths,
            scratch,
        }
    }

    /// What receivers read.
    pub(super) fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The maps, all levels.
    pub(super) fn texture(&self) -> &wgpu::Texture {
        &self.maps
    }

    /// Bytes of all textures.
    pub(super) fn bytes(&self) -> u64 {
        let texels = u64::from(self.side) * u64::from(self.side);
        let per_texel = u64::from(self.moments.bytes() / self.moments.layers());
        let levels = (0..self.maps.mip_level_count()).map(|level| (texels >> (2 * level)).max(1)).sum::<u64>();
        per_texel * (levels * u64::from(self.maps.depth_or_array_layers()) + texels)
    }

    /// Uploads what the filter has to know of each view.
    pub(super) fn prepare(&self, queue: &wgpu::Queue, frame: &ShadowFrame) {
        for (index, view) in frame.views.iter().enumerate() {
            for number in 0..self.blocks {
                let block = BlurUniforms { first_term: 2 * number, stride: SUMMED_TEXELS.pow(number), ..view.blur };
                queue.write_buffer(&self.uniforms, u64::from(self.offset(index, number)), bytemuck::bytes_of(&block));
            }
        }
    }

    /// Number of passes that a frame takes.
    fn passes(&self, frame: &ShadowFrame) -> usize {
        if self.moments.is_summed() {
            return frame.views.iter().map(|view| 2 * sums(view.blur.tile[2]) as usize).sum();
        }
        let pairs = self.moments.layers() as usize;
        pairs * (2 * frame.views.len() + layers(frame).map(|layer| halvings(frame, layer)).sum::<usize>())
    }

    /// Fills the maps. `stamps` gives the timestamps of a pass, by its number and their count.
    pub(super) fn run<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame,
        stamps: &mut dyn FnMut(usize, usize) -> Option<wgpu::RenderPassTimestampWrites<'a>>,
    ) {
        let (mut number, count) = (0, self.passes(frame));
        let mut next = || {
            number += 1;
            stamps(number - 1, count)
        };
        if self.moments.is_summed() {
            frame.views.iter().enumerate().for_each(|view| self.sum(encoder, view, &mut next));
            return;
        }
        let pairs = self.moments.layers();
        for (index, view) in frame.views.iter().enumerate() {
            for pair in 0..pairs {
                let Some(depths) = self.depths.get(view.layer as usize) else { continue };
                let Some(levels) = self.levels.get((view.layer * pairs + pair) as usize) else { continue };
                let offset = self.offset(index, pair);
                let tile = view.blur.tile;
                let (along_u, along_v) = (&self.along_u, &self.along_v);
                Pass { pipeline: along_u, group: (depths, offset), target: &self.scratch, tile }
                    .record(encoder, next());
                let group = (&self.scratch_group, offset);
                Pass { pipeline: along_v, group, target: &levels[0].0, tile }.record(encoder, next());
            }
        }
        for layer in layers(frame) {
            for pair in 0..pairs {
                let Some(levels) = self.levels.get((layer * pairs + pair) as usize) else { continue };
                for (level, pair) in levels.windows(2).enumerate().take(halvings(frame, layer)) {
                    let side = (self.side >> (level + 1)).max(1);
                    let (group, tile) = ((&pair[0].1, 0), [0, 0, side, side]);
                    Pass { pipeline: &self.further, group, target: &pair[1].0, tile }.record(encoder, next());
                }
            }
        }
    }

    /// Where a view's uniform block is.
    fn offset(&self, view: usize, number: u32) -> u32 {
        self.stride * ((view.min(MAX_VIEWS - 1) as u32) * self.blocks + number)
    }
}

/// The entry points that fill a map: from depths along u, along v, and what is left to do.
fn entries(moments: Moments) -> [&'static str; 3] {
    if moments.is_summed() {
        ["antumbra_sum_depths", "antumbra_sum_along_v", "antumbra_sum_along_u"]
    } else {
        ["antumbra_blur_along_u", "antumbra_blur_along_v", "antumbra_halve"]
    }
}

/// One triangle over a tile: what lies outside keeps what it holds.
struct Pass<'a> {
    pipeline: &'a wgpu::RenderPipeline,
    /// What it reads, and where in the uniforms its block is.
    group: (&'a wgpu::BindGroup, u32),
    target: &'a wgpu::TextureView,
    /// First x and y, side; the last number is not read.
    tile: [u32; 4],
}

impl Pass<'_> {
    fn record(&self, encoder: &mut wgpu::CommandEncoder, timestamp_writes: Option<wgpu::RenderPassTimestampWrites>) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("antumbra filter"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: self.target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: None,
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let [x, y, side, _] = self.tile;
        pass.set_pipeline(self.pipeline);
        pass.set_bind_group(0, self.group.0, &[self.group.1]);
        pass.set_scissor_rect(x, y, side, side);
        pass.draw(0..3, 0..1);
    }
}

/// How many levels of a layer are made: as many as its views read.
fn halvings(frame: &ShadowFrame, layer: u32) -> usize {
    let views = frame.views.iter().zip(&frame.uniforms.views).filter(|(view, _)| view.layer == layer);
    views.map(|(_, uniforms)| uniforms.moments[1] as usize).max().unwrap_or(0)
}

/// The layers that a frame's views lie in, each once.
fn layers(frame: &ShadowFrame) -> impl Iterator<Item = u32> + '_ {
    let mut seen = ArrayVec::<u32, MAX_VIEWS>::new();
    frame.views.iter().filter_map(move |view| {
        let new = !seen.contains(&view.layer) && seen.try_push(view.layer).is_ok();
        new.then_some(view.layer)
    })
}

/// What passes read: the uniforms, and depths or what is stored.
struct Layouts {
    depths: wgpu::BindGroupLayout,
    stored: wgpu::BindGroupLayout,
}

impl Layouts {
    fn new(device: &wgpu::Device, moments: Moments) -> Self {
        let layout = |binding, sample_type| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("antumbra filter"),
                entries: &[
                    wgpu::BindGroupLayoutEntry {
                        binding: 0,
                        visibility: wgpu::ShaderStages::FRAGMENT,
                        ty: wgpu::BindingType::Buffer {
                            ty: wgpu::BufferBindingType::Uniform,
                            has_dynamic_offset: true,
                            min_binding_size: NonZeroU64::new(size_of::<BlurUniforms>() as u64),
                        },
                        count: None,
                    },
                    wgpu::BindGroupLayoutEntry {
                        binding,
                        visibility: wgpu::ShaderStages::FRAGMENT,
                        ty: wgpu::BindingType::Texture {
                            sample_type,
                            view_dimension: wgpu::TextureViewDimension::D2,
                            multisampled: false,
                        },
                        count: None,
                    },
                ],
            })
        };
        Self {
            depths: layout(1, wgpu::TextureSampleType::Depth),
            stored: layout(2, stored_type(moments.read(false, false))),
        }
    }
}

fn pass_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    entry: &str,
    layout: &wgpu::BindGroupLayout,
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

/// `COPY_SRC` costs nothing and lets engines and tests read the maps back.
fn target(
    device: &wgpu::Device,
    label: Option<&str>,
    side: u32,
    layers: u32,
    levels: u32,
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label,
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: layers },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// One level of one layer.
fn one(texture: &wgpu::Texture, layer: u32, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}
