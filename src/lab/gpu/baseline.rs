//! What the library's passes cost beside the cheapest ones that anybody writes by hand.

use glam::{Mat4, Vec3};

use super::clock::{Clock, Stamps, Stopwatch};
use super::pipelines::{self, Host, Pair};
use super::render::Shot;
use super::{Gpu, GpuFailure, GpuScene, Renderer};
use crate::camera::Camera;
use crate::frame::{ShadowFrame, ShadowView};
use crate::gpu::{DEPTH_FORMAT, ShadowMaps};
use crate::lab::statistics::quantile;

/// The library's passes beside passes written by hand, drawn turn by turn in the same picture.
///
/// The yardstick for casters is a depth pass with one matrix; the yardstick for receivers is one matrix, one comparison
/// sample and a constant bias, in three hosts: *bare* (nobody reads a normal), *shaded* (both sides shade what arrives
/// with Lambert's cosine, as engines do, and need the normal for it) and *at vertices* (its matrix, too, is left to the
/// vertex stage). Beside several maps it draws each of them, and looks everything up in one. Both sides draw the same
/// triangles into targets of the same size. Every repetition times all of them, in alternating order, those of a ratio
/// one after the other; the medians of the ratios are robust against other work on the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Race {
    /// Library's caster pass, median, milliseconds.
    pub casters_ms: f64,
    /// Caster pass by hand, median, milliseconds.
    pub casters_by_hand_ms: f64,
    /// Median of the ratios library / by hand.
    pub casters_ratio: f64,
    /// Library's receiver pass as [`Renderer::render`] draws it, median, milliseconds.
    pub receivers_ms: f64,
    /// Bare receiver pass by hand, median, milliseconds.
    pub receivers_by_hand_ms: f64,
    /// Median of the ratios library / by hand, both shaded.
    pub receivers_ratio: f64,
    /// The same, both bare of shading: by hand nobody reads a normal, the library does for its bias.
    pub receivers_bare_ratio: f64,
    /// The same, with the matrix of the pass by hand moved to the vertex stage.
    pub receivers_vertex_ratio: f64,
    /// `antumbra_visibility` at each fragment / by hand, both shaded.
    pub whole_ratio: f64,
    /// The same, both bare of shading.
    pub whole_bare_ratio: f64,
    /// The clock.
    pub clock: Clock,
}

/// What is timed; neighbours are compared.
#[derive(Clone, Copy)]
enum Entrant {
    Casters,
    CastersByHand,
    Whole,
    BareByHand,
    Receivers,
    VertexByHand,
    Shaded,
    ShadedByHand,
    WholeShaded,
}

impl Entrant {
    const ALL: [Self; 9] = [
        Self::Casters,
        Self::CastersByHand,
        Self::Whole,
        Self::BareByHand,
        Self::Receivers,
        Self::VertexByHand,
        Self::Shaded,
        Self::ShadedByHand,
        Self::WholeShaded,
    ];
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
        // Draw all once: whoever comes first pays for the caches.
        let shot = Shot::new(self, gpu, scene, camera, frame, maps)?;
        let track = Track { entries: Entries::new(gpu, self, &shot, maps), renderer: self, maps, shot };
        let stopwatch = Stopwatch::new(gpu);
        stopwatch.time(|encoder, _| track.shot.depth_pass(encoder))?;
        let mut runs = Runs::default();
        track.turn(&stopwatch, true)?;
        // Take turns.
        for repetition in 0..repetitions.max(1) {
            runs.push(track.turn(&stopwatch, repetition % 2 == 0)?);
        }
        Ok(if frame.views.is_empty() { Runs::default() } else { runs }.summary(stopwatch.clock()))
    }
}

/// What the entrants run on.
struct Track<'a> {
    shot: Shot<'a>,
    renderer: &'a Renderer,
    maps: &'a ShadowMaps,
    entries: Entries,
}

/// Times of one repetition, milliseconds, in the order of [`Entrant::ALL`].
type Turn = [f64; Entrant::ALL.len()];

impl Track<'_> {
    /// One repetition, forwards or backwards.
    fn turn(&self, stopwatch: &Stopwatch, forwards: bool) -> Result<Turn, GpuFailure> {
        let mut times = Turn::default();
        for place in 0..times.len() {
            let entrant = Entrant::ALL[if forwards { place } else { times.len() - 1 - place }];
            times[entrant as usize] = stopwatch.time(|encoder, stamps| self.run(entrant, encoder, stamps))?;
        }
        Ok(times)
    }

    fn run(&self, entrant: Entrant, encoder: &mut wgpu::CommandEncoder, stamps: Stamps) {
        let (shot, entries) = (&self.shot, &self.entries);
        let (library, by_hand) = (self.maps.bind_group(), &entries.by_hand_group);
        let (pair, group) = match entrant {
            Entrant::Casters => return shot.caster_passes(encoder, stamps),
            Entrant::CastersByHand => return entries.caster_passes(encoder, stamps, shot),
            Entrant::Receivers => (self.renderer.receivers(), library),
            Entrant::Shaded => (&entries.shaded, library),
            Entrant::Whole => (&entries.whole, library),
            Entrant::WholeShaded => (&entries.whole_shaded, library),
            Entrant::BareByHand => (&entries.bare_by_hand, by_hand),
            Entrant::VertexByHand => (&entries.vertex_by_hand, by_hand),
            Entrant::ShadedByHand => (&entries.shaded_by_hand, by_hand),
        };
        shot.receiver_pass(encoder, stamps, pair, group);
    }
}

/// Times of all repetitions.
#[derive(Default)]
struct Runs(Vec<Turn>);

impl Runs {
    fn push(&mut self, times: Turn) {
        self.0.push(times);
    }

    fn summary(&self, clock: Clock) -> Race {
        let of = |figure: &dyn Fn(&Turn) -> f64| quantile(&self.0.iter().map(figure).collect::<Vec<_>>(), 0.5);
        let ms = |entrant: Entrant| of(&|times| times[entrant as usize]);
        let ratio = |ours: Entrant, theirs: Entrant| of(&|times| times[ours as usize] / times[theirs as usize]);
        Race {
            casters_ms: ms(Entrant::Casters),
            casters_by_hand_ms: ms(Entrant::CastersByHand),
            casters_ratio: ratio(Entrant::Casters, Entrant::CastersByHand),
            receivers_ms: ms(Entrant::Receivers),
            receivers_by_hand_ms: ms(Entrant::BareByHand),
            receivers_ratio: ratio(Entrant::Shaded, Entrant::ShadedByHand),
            receivers_bare_ratio: ratio(Entrant::Receivers, Entrant::BareByHand),
            receivers_vertex_ratio: ratio(Entrant::Receivers, Entrant::VertexByHand),
            whole_ratio: ratio(Entrant::WholeShaded, Entrant::ShadedByHand),
            whole_bare_ratio: ratio(Entrant::Whole, Entrant::BareByHand),
            clock,
        }
    }
}

/// The passes that the renderer does not have.
struct Entries {
    casters_by_hand: Pair,
    caster_groups: Vec<wgpu::BindGroup>,
    map: wgpu::TextureView,
    bare_by_hand: Pair,
    vertex_by_hand: Pair,
    shaded_by_hand: Pair,
    by_hand_group: wgpu::BindGroup,
    shaded: Pair,
    whole: Pair,
    whole_shaded: Pair,
}

impl Entries {
    fn new(gpu: &Gpu, renderer: &Renderer, shot: &Shot, maps: &ShadowMaps) -> Self {
        // Casters: a map of the same size, which every view is drawn into, and a matrix for each view.
        let map = map_by_hand(gpu, maps.depth_texture().size());
        let casters_by_hand = pipelines::casters_by_hand(gpu, renderer.caster_layout());
        let caster_groups = shot.views().iter().map(|view| caster_group(gpu, renderer.caster_layout(), view)).collect();
        // Receivers by hand: the first view's map.
        let layout = receiver_layout(gpu);
        let by_hand = |host| {
            pipelines::receiver_pair(gpu, "receivers by hand", include_str!("light_by_hand.wgsl"), host, &layout)
        };
        let matrix = shot.views().first().map_or(Mat4::IDENTITY, texture_from_render);
        let by_hand_group = receiver_group(gpu, &layout, &map, &matrix);
        // The library's receivers in other hosts than the renderer's.
        let library = |host| pipelines::library_receivers(gpu, renderer.key(), host);
        Self {
            casters_by_hand,
            caster_groups,
            map,
            bare_by_hand: by_hand(Host::Bare),
            vertex_by_hand: by_hand(Host::Placed),
            shaded_by_hand: by_hand(Host::WholeShaded),
            by_hand_group,
            shaded: library(Host::shaded(renderer.key())),
            whole: library(Host::Whole),
            whole_shaded: library(Host::WholeShaded),
        }
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
            shot.scene.draw(&mut pass, batches, &self.casters_by_hand);
        }
    }
}

fn map_by_hand(gpu: &Gpu, size: wgpu::Extent3d) -> wgpu::TextureView {
    let map = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("map by hand"),
        size: wgpu::Extent3d { depth_or_array_layers: 1, ..size },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    map.create_view(&wgpu::TextureViewDescriptor::default())
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
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
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
