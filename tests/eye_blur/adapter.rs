//! The passes on an adapter, against their twin.

use std::mem::offset_of;

use antumbra::encoding::eye_blur::{EyeBlur, EyeBlurUniforms};
use antumbra::gpu::{ScreenBlur, ScreenBlurViews, wgpu};
use antumbra::lab::eye_blur::blur;
use antumbra::lab::gpu::Gpu;
use antumbra::transpile::Shader;
use antumbra::transpile::naga::TypeInner;
use antumbra::wgsl;

use crate::support::compute::{compute, storage};
use crate::{SIZE, camera, depths, of, support};

fn texture(gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::Texture {
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width: SIZE.x, height: SIZE.y, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Writes a mask and depths, pixel by pixel.
fn writer(gpu: &Gpu) -> wgpu::RenderPipeline {
    let text = "
        @group(0) @binding(0) var<storage, read> mask: array<f32>;
        @group(0) @binding(1) var<storage, read> depths: array<f32>;
        override width: u32;
        struct Pixel { @location(0) mask: vec4f, @builtin(frag_depth) depth: f32 }
        @vertex fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
            return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.5, 1.0);
        }
        @fragment fn write(@builtin(position) at: vec4f) -> Pixel {
            let index = u32(at.y) * width + u32(at.x);
            return Pixel(vec4f(mask[index]), depths[index]);
        }";
    let (device, label) = (gpu.device(), Some("picture"));
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
    let constants: &[(&str, f64)] = &[("width", f64::from(SIZE.x))];
    let depth_stencil = wgpu::DepthStencilState {
        depth_compare: Some(wgpu::CompareFunction::Always),
        ..antumbra::gpu::depth_stencil_state()
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(depth_stencil),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("write"),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            targets: &[Some(wgpu::TextureFormat::R32Float.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws a mask and depths.
fn drawn(gpu: &Gpu, mask: &[f32], depth: &[f32]) -> [wgpu::TextureView; 2] {
    let (device, label, pipeline) = (gpu.device(), Some("picture"), writer(gpu));
    let [mask, depth] = [mask, depth].map(|values| storage(gpu, bytemuck::cast_slice(values)));
    let entries = [(0, &mask), (1, &depth)]
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
    let layout = pipeline.get_bind_group_layout(0);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout: &layout, entries: &entries });
    let views = [wgpu::TextureFormat::R32Float, antumbra::gpu::DEPTH_FORMAT]
        .map(|format| texture(gpu, format).create_view(&wgpu::TextureViewDescriptor::default()));
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
    let (view, depth_slice, resolve_target) = (&views[0], None, None);
    let colour = wgpu::RenderPassColorAttachment { view, depth_slice, resolve_target, ops };
    let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store });
    let depth = wgpu::RenderPassDepthStencilAttachment { view: &views[1], depth_ops, stencil_ops: None };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label,
        color_attachments: &[Some(colour)],
        depth_stencil_attachment: Some(depth),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    gpu.queue().submit([encoder.finish()]);
    views
}

/// What a texture shows, pixel by pixel.
fn read(gpu: &Gpu, view: &wgpu::TextureView) -> Vec<f32> {
    let text = "
        @group(0) @binding(0) var<storage, read> pixels: array<vec2u>;
        @group(0) @binding(1) var<storage, read_write> found: array<f32>;
        @group(1) @binding(0) var picture: texture_2d<f32>;
        @compute @workgroup_size(64) fn run(@builtin(global_invocation_id) id: vec3u) {
            if id.x < arrayLength(&pixels) { found[id.x] = textureLoad(picture, pixels[id.x], 0).x; }
        }";
    let pixels: Vec<[u32; 2]> = (0..SIZE.x * SIZE.y).map(|index| [index % SIZE.x, index / SIZE.x]).collect();
    let entry = wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(view) };
    compute(gpu, text, &pixels, &[entry])
}

/// Noise on slopes, steps and sky.
#[test]
fn passes_agree_with_their_twin() {
    let Some(gpu) = support::gpu() else { return };
    let noise = |x: u32, y: u32| f64::from((x * 7919 + y * 104_729 + x * y * 31) % 101) / 100.0;
    let mask = of(noise);
    let ground = |x: u32, y: u32| match (x, y) {
        (150.., 90..) => 1e30,
        (60..=100, _) => 2.5,
        _ => 4.0 + 0.02 * f64::from(x) + 0.01 * f64::from(y),
    };
    let depth = depths(ground);
    let [source, depth_view] = drawn(&gpu, &mask, &depth);
    let target = texture(&gpu, wgpu::TextureFormat::R32Float).create_view(&wgpu::TextureViewDescriptor::default());
    let passes = ScreenBlur::new(gpu.device(), SIZE, wgpu::TextureFormat::R32Float);
    for (iterations, radius) in [(1, 0.08), (2, 0.2), (4, 0.05), (16, 0.1), (3, 0.0)] {
        let settings = EyeBlur { radius, iterations, edge: 6.3, ..EyeBlur::default() };
        passes.prepare(gpu.queue(), &settings, &camera()).unwrap();
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let views = ScreenBlurViews { source: &source, depth: &depth_view, target: &target };
        let mut counted = Vec::new();
        passes.blur(gpu.device(), &mut encoder, &views, &settings, &mut |pass, count| {
            counted.push((pass, count));
            None
        });
        gpu.queue().submit([encoder.finish()]);
        let count = 2 * iterations as usize;
        assert_eq!(counted, (0..count).map(|pass| (pass, count)).collect::<Vec<_>>());
        let found = read(&gpu, &target);
        let twin = blur(&settings.uniforms(&camera(), SIZE).unwrap(), iterations, SIZE, &mask, &depth);
        let worst = found.iter().zip(&twin).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        // A pass rounds the exponentials and the sums of up to 40 pixels; averages take no more over than that.
        let most = count as f32 * 4e-6;
        let changed = twin.iter().zip(&mask).map(|(after, before)| (after - before).abs()).fold(0.0, f32::max);
        println!("{iterations} × {radius}: {worst:e} of {most:e}, changed by up to {changed}");
        assert!(worst <= most, "{iterations} × {radius}: {worst} of {most}");
        assert_eq!(changed > 0.2, radius > 0.0, "the blur does something");
    }
}

/// The text is one module, and its uniforms are what is uploaded, member by member.
#[test]
fn layouts_agree() {
    let shader = Shader::parse(wgsl::EYE_BLUR).unwrap();
    let module = &shader.module;
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("AntumbraEyeBlur")).unwrap();
    let TypeInner::Struct { members, span } = &found.inner else { panic!("no struct") };
    let members: Vec<_> =
        members.iter().map(|member| (member.name.as_deref().unwrap_or(""), member.offset as usize)).collect();
    let expected = [
        ("eye_depth", offset_of!(EyeBlurUniforms, eye_depth)),
        ("pixels", offset_of!(EyeBlurUniforms, pixels)),
        ("most", offset_of!(EyeBlurUniforms, most)),
        ("edge", offset_of!(EyeBlurUniforms, edge)),
        ("padding", offset_of!(EyeBlurUniforms, padding)),
    ];
    assert_eq!(members, expected);
    assert_eq!(*span as usize, size_of::<EyeBlurUniforms>());
}
