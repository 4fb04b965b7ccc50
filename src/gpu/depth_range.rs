//! The range of what is seen, out of the engine's depth buffer, without a stall.
//!
//! A compute pass reduces the depth buffer to two numbers, which are read back while later frames are drawn. What
//! arrives is the range of an earlier frame: one or two frames old as a rule, three at most before a frame is passed
//! over. Engines that hand it to a fit as `scene.visible_depth` widen it by as much as the camera may have come nearer
//! or gone away in that time: receivers outside of the range read lit.
//!
//! # References
//! - Lauritzen, Salvi & Lefohn, *Sample distribution shadow maps*, 2011.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use glam::DMat4;

use crate::scene::DepthRange;

/// Results that may be on their way: fewer pass over frames where the GPU is far behind, more only wait longer.
const IN_FLIGHT: usize = 3;

/// Least and greatest depth, four bytes each.
const BYTES: u64 = 8;

/// Pixels along a side of a workgroup, as in the shader.
const GROUP: u32 = 16;

/// Nothing was drawn: the range is empty.
const EMPTY: [u32; 2] = [u32::MAX, 0];

/// States of a result on its way.
const FREE: u8 = 0;
const RECORDED: u8 = 1;
const ASKED_FOR: u8 = 2;
const ARRIVED: u8 = 3;
const LOST: u8 = 4;

/// Finds the range of depth buffers, frame by frame.
#[derive(Debug)]
pub struct DepthRangeProbe {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    range: wgpu::Buffer,
    empty: wgpu::Buffer,
    results: [Pending; IN_FLIGHT],
    /// Counts recorded frames, so that the newest result wins.
    frames: u64,
    /// The newest result, and the frame it is of.
    latest: Option<(u64, [u32; 2])>,
}

#[derive(Debug)]
struct Pending {
    buffer: wgpu::Buffer,
    state: Arc<AtomicU8>,
    frame: u64,
}

impl DepthRangeProbe {
    /// Makes the pipeline and its buffers.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let label = Some("antumbra depth range");
        let source = wgpu::ShaderSource::Wgsl(include_str!("../../shaders/depth_range.wgsl").into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: None,
            module: &module,
            entry_point: Some("antumbra_depth_range"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let buffer = |usage, mapped_at_creation| {
            device.create_buffer(&wgpu::BufferDescriptor { label, size: BYTES, usage, mapped_at_creation })
        };
        let empty = buffer(wgpu::BufferUsages::COPY_SRC, true);
        // A buffer mapped at creation is mapped; a lost device leaves it unwritten, and finds nothing anyway.
        if let Ok(mut mapped) = empty.get_mapped_range_mut(..) {
            mapped.copy_from_slice(bytemuck::bytes_of(&EMPTY));
        }
        empty.unmap();
        let pending = || Pending {
            buffer: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ, false),
            state: Arc::new(AtomicU8::new(FREE)),
            frame: 0,
        };
        Self {
            layout: pipeline.get_bind_group_layout(0),
            pipeline,
            range: buffer(
                wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                false,
            ),
            empty,
            results: core::array::from_fn(|_| pending()),
            frames: 0,
            latest: None,
        }
    }

    /// Records the reduction of a depth buffer, of `width × height` pixels, not multisampled, made with
    /// `TEXTURE_BINDING`. After the submission of `encoder` call [`submitted`](Self::submitted).
    ///
    /// False, and nothing is recorded, while all results are on their way: the frame is passed over, nothing waits.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        [width, height]: [u32; 2],
    ) -> bool {
        self.collect();
        let Some(result) = self.results.iter_mut().find(|result| result.state.load(Ordering::Acquire) == FREE) else {
            return false;
        };
        self.frames += 1;
        result.frame = self.frames;
        result.state.store(RECORDED, Ordering::Release);
        let label = Some("antumbra depth range");
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label,
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(depth) },
                wgpu::BindGroupEntry { binding: 1, resource: self.range.as_entire_binding() },
            ],
        });
        encoder.copy_buffer_to_buffer(&self.empty, 0, &self.range, 0, BYTES);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(width.div_ceil(GROUP), height.div_ceil(GROUP), 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.range, 0, &result.buffer, 0, BYTES);
        true
    }

    /// Asks for what was recorded; it arrives when the engine polls its device or submits later frames.
    pub fn submitted(&mut self) {
        for result in self.results.iter().filter(|result| result.state.load(Ordering::Acquire) == RECORDED) {
            result.state.store(ASKED_FOR, Ordering::Release);
            let state = Arc::clone(&result.state);
            result.buffer.map_async(wgpu::MapMode::Read, .., move |arrived| {
                state.store(if arrived.is_ok() { ARRIVED } else { LOST }, Ordering::Release);
            });
        }
    }

    /// The newest range that has arrived, as eye depths of a camera with this projection (any depth convention, finite
    /// or infinite far plane); `None` until the first one arrives, and where nothing was drawn.
    pub fn latest(&mut self, clip_from_view: &DMat4) -> Option<DepthRange> {
        self.collect();
        let (_, bits) = self.latest?;
        if bits == EMPTY {
            return None;
        }
        let [one, other] = bits.map(|bits| eye_depth(clip_from_view, f64::from(f32::from_bits(bits))));
        let range = DepthRange { near: one.min(other), far: one.max(other) };
        (range.near.is_finite() && range.far.is_finite()).then_some(range)
    }

    /// How many frames ago the latest range was recorded; `None` until one arrives.
    #[must_use]
    pub fn age(&self) -> Option<u64> {
        self.latest.map(|(frame, _)| self.frames - frame)
    }

    /// Takes what has arrived.
    fn collect(&mut self) {
        for result in &self.results {
            let state = result.state.load(Ordering::Acquire);
            if state == ARRIVED {
                if let Ok(bytes) = result.buffer.get_mapped_range(..) {
                    let bits: [u32; 2] = bytemuck::pod_read_unaligned(&bytes);
                    if self.latest.is_none_or(|(frame, _)| frame < result.frame) {
                        self.latest = Some((result.frame, bits));
                    }
                }
                result.buffer.unmap();
            }
            if state == ARRIVED || state == LOST {
                result.state.store(FREE, Ordering::Release);
            }
        }
    }
}

/// Eye depth of a value of the depth buffer: where the projection's third and fourth row have that ratio on the view
/// axis.
fn eye_depth(clip_from_view: &DMat4, depth: f64) -> f64 {
    let [z, w] = [clip_from_view.row(2), clip_from_view.row(3)];
    (w.w * depth - z.w) / (w.z * depth - z.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Standard, reversed and endless perspective, and orthographic.
    #[test]
    fn depths_of_all_conventions() {
        let (near, far) = (0.5, 80.0);
        let standard = glam::DMat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, far / (near - far), -1.0],
            [0.0, 0.0, near * far / (near - far), 0.0],
        ]);
        let mut reversed = standard;
        (reversed.z_axis.z, reversed.w_axis.z) = (near / (far - near), near * far / (far - near));
        let mut endless = standard;
        (endless.z_axis.z, endless.w_axis.z) = (0.0, near);
        let mut orthographic = standard;
        (orthographic.z_axis.z, orthographic.z_axis.w) = (1.0 / (near - far), 0.0);
        (orthographic.w_axis.z, orthographic.w_axis.w) = (near / (near - far), 1.0);
        for matrix in [standard, reversed, endless, orthographic] {
            for eye in [0.5, 1.0, 7.0, 80.0] {
                let clip = matrix * glam::DVec4::new(0.0, 0.0, -eye, 1.0);
                let found = eye_depth(&matrix, clip.z / clip.w);
                assert!((found - eye).abs() < 1e-9, "{found} instead of {eye}");
            }
        }
    }
}
