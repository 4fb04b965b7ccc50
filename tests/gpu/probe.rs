//! The range of a depth buffer, read back without a wait.

use antumbra::gpu::{DEPTH_FORMAT, DepthRangeProbe, wgpu};
use antumbra::lab::gpu::Gpu;
use glam::{DMat4, DVec4};

use crate::support;

const SIZE: [u32; 2] = [75, 50];

/// Draws depths from `near` to `far` over the picture, but for its left quarter, which stays cleared.
const TEXT: &str = "
struct Vertex { @builtin(position) position: vec4f }
@group(0) @binding(0) var<uniform> ends: vec4f;
@vertex fn vertex(@builtin(vertex_index) index: u32) -> Vertex {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return Vertex(vec4f(corner * 4.0 - 1.0, 0.5, 1.0));
}
@fragment fn fragment(in: Vertex) -> @builtin(frag_depth) f32 {
    if (in.position.x < 19.0) { discard; }
    return mix(ends.x, ends.y, (in.position.x - 19.5) / 55.0);
}";

fn draw(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView, ends: Option<[f32; 2]>) {
    let device = gpu.device();
    let source = wgpu::ShaderSource::Wgsl(TEXT.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let uniform = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let [near, far] = ends.unwrap_or_default();
    gpu.queue().write_buffer(&uniform, 0, bytemuck::bytes_of(&[near, far, 0.0, 0.0]));
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
    });
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    if ends.is_some() {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

#[test]
fn depth_ranges_arrive_without_a_wait() {
    let Some(gpu) = support::gpu() else { return };
    let device = gpu.device();
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    // near 1, far 100, reversed: depth = (100 / eye − 1) / 99.
    let projection = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, 1.0 / 99.0, -1.0),
        DVec4::new(0.0, 0.0, 100.0 / 99.0, 0.0),
    );
    let depth_of = |eye: f32| (100.0 / eye - 1.0) / 99.0;
    let mut probe = DepthRangeProbe::new(device);
    let mut frame = |ends: Option<[f32; 2]>| {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        draw(&gpu, &mut encoder, &view, ends);
        let recorded = probe.record(device, &mut encoder, &view, SIZE);
        gpu.queue().submit([encoder.finish()]);
        probe.submitted();
        (recorded, probe.latest(&projection))
    };
    // Nothing has arrived by the time the first frame is asked for.
    let (recorded, _) = frame(Some([depth_of(2.0), depth_of(50.0)]));
    assert!(recorded);
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let (recorded, range) = frame(Some([depth_of(4.0), depth_of(9.0)]));
    let range = range.expect("the first frame's");
    assert!(recorded && (range.near - 2.0).abs() < 1e-3 && (range.far - 50.0).abs() < 1e-2, "{range:?}");
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    // A frame without geometry has no range.
    let (_, range) = frame(None);
    let range = range.expect("the second frame's");
    assert!((range.near - 4.0).abs() < 1e-3 && (range.far - 9.0).abs() < 1e-2, "{range:?}");
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    assert_eq!(probe.latest(&projection), None);
    assert_eq!(probe.age(), Some(0));
    // An engine that never polls is never waited for: frames are passed over.
    let mut passed_over = false;
    for _ in 0..8 {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        passed_over |= !probe.record(device, &mut encoder, &view, SIZE);
        probe.record(device, &mut encoder, &view, SIZE);
    }
    assert!(passed_over);
}
