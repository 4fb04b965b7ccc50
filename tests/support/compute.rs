//! Compute shaders over arrays of cases.

use antumbra::gpu::wgpu;
use antumbra::lab::gpu::Gpu;
use bytemuck::Pod;

/// Runs a shader's compute entry point `run` on every case, 64 to a workgroup: group 0 is the cases and what is found
/// of each, group 1 whatever `others` are.
pub(crate) fn compute<Case: Pod, Found: Pod>(
    gpu: &Gpu,
    text: &str,
    cases: &[Case],
    others: &[wgpu::BindGroupEntry],
) -> Vec<Found> {
    // The pipeline.
    let device = gpu.device();
    let label = std::any::type_name::<Found>();
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: None,
        module: &module,
        entry_point: Some("run"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    // The buffers.
    let size = (size_of::<Found>() * cases.len()) as u64;
    let input = storage(gpu, bytemuck::cast_slice(cases));
    let output = buffer(gpu, size, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(gpu, size, wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    let group = |index: u32, entries: &[wgpu::BindGroupEntry]| {
        let layout = pipeline.get_bind_group_layout(index);
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout: &layout, entries })
    };
    let [cases_entry, found_entry] = [(0, &input), (1, &output)]
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
    let data = group(0, &[cases_entry, found_entry]);
    // Run.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &data, &[]);
    if !others.is_empty() {
        pass.set_bind_group(1, &group(1, others), &[]);
    }
    pass.dispatch_workgroups(cases.len().div_ceil(64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&output, 0, &read, 0, size);
    gpu.queue().submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    bytemuck::pod_collect_to_vec(&read.get_mapped_range(..).unwrap())
}

/// A storage buffer with contents.
pub(crate) fn storage(gpu: &Gpu, bytes: &[u8]) -> wgpu::Buffer {
    let storage = buffer(gpu, bytes.len() as u64, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST);
    gpu.queue().write_buffer(&storage, 0, bytes);
    storage
}

fn buffer(gpu: &Gpu, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device().create_buffer(&wgpu::BufferDescriptor { label: Some("test"), size, usage, mapped_at_creation: false })
}
