//! What the library's passes cost beside the cheapest ones that anybody writes by hand.

use glam::{Mat4, Vec3};

use super::clock::{Clock, Stamps, Stopwatch, median};
use super::pipelines::{self, Pair};
use super::render::Shot;
use super::{Gpu, GpuFailure, GpuScene, Renderer};
use crate::camera::Camera;
use crate::frame::{ShadowFrame, ShadowView};
use crate::gpu::{DEPTH_FORMAT, ShadowMaps};

/// The library's passes beside passes written by hand, drawn turn by turn in the same picture.
///
/// The yardstick for casters is a depth pass with one matrix; the yardstick for receivers is one matrix, one comparison
/// sample and a constant bias. Both draw the same triangles into targets of the same size, and both receivers shade what
/// arrives with Lambert's cosine: without a use for the normal a driver takes it out of the vertex stage, and the race would
/// compare vertex stages. Every repetition times all four, in alternating order, and gives two ratios; the medians of those
/// are robust against other work on the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Race {
    /// Library's caster pass, median, milliseconds.
    pub casters_ms: f64,
    /// Caster pass by hand, median, milliseconds.
    pub casters_by_hand_ms: f64,
    /// Median of the ratios library / by hand.
    pub casters_ratio: f64,
    /// Library's receiver pass, median, milliseconds.
    pub receivers_ms: f64,
    /// Receiver pass by hand, median, milliseconds.
    pub receivers_by_hand_ms: f64,
    /// Median of the ratios library / by hand.
    pub receivers_ratio: f64,
    /// The clock.
    pub clock: Clock,
}

impl Renderer {
    /// Runs the library's passes beside the yardsticks, `repetitions` times (at least once).
    ///
    /// # Errors
    /// As [`render`](Self::render); a frame without views has nothing to compare and gives NaN.
    pub fn race(
        &self,
        gpu: &Gpu,
        scene: &GpuScene,
        camera: &Camera,
        frame: &ShadowFrame,
        maps: &ShadowMaps,
        repetitions: u32,
    ) -> Result<Race, GpuFailure> {
        // Draw both once: whoever comes first pays for the caches.
        let shot = Shot::new(self, gpu, scene, camera, frame, maps)?;
        let by_hand = ByHand::new(gpu, self, &shot, maps);
        let stopwatch = Stopwatch::new(gpu);
        stopwatch.time(|encoder, _| shot.depth_pass(encoder))?;
        let mut runs = Runs::default();
        Self::turn(&stopwatch, &shot, &by_hand, maps, true)?;
        // Take turns.
        for repetition in 0..repetitions.max(1) {
            runs.push(Self::turn(&stopwatch, &shot, &by_hand, maps, repetition % 2 == 0)?);
        }
        let clock = stopwatch.clock();
        Ok(if frame.views.is_empty() { Runs::default().summary(clock) } else { runs.summary(clock) })
    }

    /// One repetition: library and yardstick, casters and receivers, in milliseconds.
    fn turn(
        stopwatch: &Stopwatch,
        shot: &Shot,
        by_hand: &ByHand,
        maps: &ShadowMaps,
        library_first: bool,
    ) -> Result<[f64; 4], GpuFailure> {
        let mut times = [0.0; 4];
        for second in [false, true] {
            if second == library_first {
                times[1] = stopwatch.time(|encoder, stamps| by_hand.caster_passes(encoder, stamps, shot))?;
                times[3] = stopwatch.time(|encoder, stamps| {
                    shot.receiver_pass(encoder, stamps, &by_hand.receivers, &by_hand.receiver_group);
                })?;
            } else {
                times[0] = stopwatch.time(|encoder, stamps| shot.caster_passes(encoder, stamps))?;
                times[2] = stopwatch.time(|encoder, stamps| {
                    shot.receiver_pass(encoder, stamps, &by_hand.library, maps.bind_group());
                })?;
            }
        }
        Ok(times)
    }
}

/// Times of all repetitions: casters, casters by hand, receivers, receivers by hand.
#[derive(Default)]
struct Runs {
    times: [Vec<f64>; 4],
    ratios: [Vec<f64>; 2],
}

impl Runs {
    fn push(&mut self, times: [f64; 4]) {
        for (all, time) in self.times.iter_mut().zip(times) {
            all.push(time);
        }
        self.ratios[0].push(times[0] / times[1]);
        self.ratios[1].push(times[2] / times[3]);
    }

    fn summary(mut self, clock: Clock) -> Race {
        let [casters_ms, casters_by_hand_ms, receivers_ms, receivers_by_hand_ms] =
            self.times.each_mut().map(|times| median(times));
        let [casters_ratio, receivers_ratio] = self.ratios.each_mut().map(|ratios| median(ratios));
        Race {
            casters_ms,
            casters_by_hand_ms,
            casters_ratio,
            receivers_ms,
            receivers_by_hand_ms,
            receivers_ratio,
            clock,
        }
    }
}

/// Passes that know nothing of the library.
struct ByHand {
    casters: Pair,
    caster_groups: Vec<wgpu::BindGroup>,
    map: wgpu::TextureView,
    receivers: Pair,
    /// The library's receivers, shaded in the same way.
    library: Pair,
    receiver_group: wgpu::BindGroup,
}

impl ByHand {
    fn new(gpu: &Gpu, renderer: &Renderer, shot: &Shot, maps: &ShadowMaps) -> Self {
        // Casters: a map of the same size, and a matrix for each view.
        let size = maps.depth_texture().size();
        let map = gpu.device().create_texture(&wgpu::TextureDescriptor {
            label: Some("map by hand"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let map = map.create_view(&wgpu::TextureViewDescriptor::default());
        let text = [include_str!("cutout.wgsl"), include_str!("by_hand_casters.wgsl")].concat();
        let casters = pipelines::caster_pair(gpu, "casters by hand", &text, None, renderer.caster_layout());
        let caster_groups = shot.views().iter().map(|view| caster_group(gpu, renderer.caster_layout(), view)).collect();
        // Receivers: the first view's map.
        let text = [pipelines::STAGE, pipelines::SHADE, include_str!("by_hand.wgsl")].concat();
        let layout = receiver_layout(gpu);
        let receivers = pipelines::receiver_pair(gpu, "receivers by hand", &text, &layout);
        let matrix = shot.views().first().map_or(Mat4::IDENTITY, texture_from_render);
        let receiver_group = receiver_group(gpu, &layout, &map, &matrix);
        let library = pipelines::shaded_receivers(gpu, renderer.key());
        Self { casters, caster_groups, map, receivers, library, receiver_group }
    }

    fn caster_passes(&self, encoder: &mut wgpu::CommandEncoder, stamps: Stamps, shot: &Shot) {
        let count = self.caster_groups.len();
        for (index, (group, batches)) in self.caster_groups.iter().zip(&shot.casters).enumerate() {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("casters by hand"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.map,
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
                    stencil_ops: None,
                }),
                timestamp_writes: stamps.of_pass(index, count),
                ..Default::default()
            });
            pass.set_bind_group(0, group, &[0]);
            shot.scene.draw(&mut pass, batches, &self.casters);
        }
    }
}

/// Texture coordinates and depth in one matrix, as every tutorial has it.
fn texture_from_render(view: &ShadowView) -> Mat4 {
    let texture_from_clip =
        Mat4::from_translation(Vec3::new(0.5, 0.5, 0.0)) * Mat4::from_scale(Vec3::new(0.5, -0.5, 1.0));
    texture_from_clip * view.clip_from_render
}

fn caster_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, view: &ShadowView) -> wgpu::BindGroup {
    let matrix = pipelines::uniform_buffer(gpu, "light by hand", bytemuck::bytes_of(&view.clip_from_render));
    gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("casters by hand"),
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() }],
    })
}

fn receiver_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT;
    let map = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let compare = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("receivers by hand"),
        entries: &[
            pipelines::uniform_entry(0, visibility, false),
            wgpu::BindGroupLayoutEntry { binding: 1, visibility, ty: map, count: None },
            wgpu::BindGroupLayoutEntry { binding: 2, visibility, ty: compare, count: None },
        ],
    })
}

fn receiver_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    map: &wgpu::TextureView,
    texture_from_render: &Mat4,
) -> wgpu::BindGroup {
    let matrix = pipelines::uniform_buffer(gpu, "receivers by hand", bytemuck::bytes_of(texture_from_render));
    let compare = gpu.device().create_sampler(&wgpu::SamplerDescriptor {
        label: Some("receivers by hand"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    });
    gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("receivers by hand"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(map) },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&compare) },
        ],
    })
}
