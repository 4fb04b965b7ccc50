//! Pipelines: solid triangles and triangles with cut-outs, for every pass.

use wgpu::VertexFormat::{Float32x2, Float32x3, Snorm16x4};

use super::{Gpu, scene::Attributes};
use crate::frame::{MapShape, Pcf, WgslKey};
use crate::gpu;
use crate::wgsl::{self, Bindings};

/// Format of the picture: visibility, 0 to 1.
pub(super) const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// The camera's passes: what they share.
const STAGE: &str = concat!(include_str!("stage.wgsl"), include_str!("cutout.wgsl"));

/// A pass for solid triangles, and the same for triangles with cut-outs.
#[derive(Debug)]
pub(super) struct Pair {
    pub(super) solid: wgpu::RenderPipeline,
    pub(super) cut: wgpu::RenderPipeline,
}

/// How the two pipelines of a pair differ, and all that they share.
pub(super) struct PairDescriptor<'a> {
    pub(super) label: &'static str,
    pub(super) text: &'a str,
    /// Bind groups 0 and 1; 2 is the cut-out's.
    pub(super) groups: [Option<&'a wgpu::BindGroupLayout>; 2],
    /// Vertex and fragment entry points; solid depth passes have no fragment shader at all.
    pub(super) solid: (&'static str, Option<&'static str>),
    pub(super) cut: (&'static str, &'static str),
    pub(super) depth: wgpu::DepthStencilState,
    /// The picture's format; none for depth passes.
    pub(super) target: Option<wgpu::TextureFormat>,
    /// Faces that are not drawn.
    pub(super) cull: Option<wgpu::Face>,
}

/// The library's pass over casters: its layout, its matrix, its vertex function; without the faces that are culled.
pub(super) fn casters(
    gpu: &Gpu,
    shape: MapShape,
    caster_layout: &wgpu::BindGroupLayout,
    cull: Option<wgpu::Face>,
) -> Pair {
    let (stage, solid) = match shape {
        MapShape::Affine | MapShape::ProjectiveDepth => {
            (concat!(include_str!("casters.wgsl"), include_str!("casters_library.wgsl")), None)
        }
        MapShape::Projective => (include_str!("casters_projective.wgsl"), Some("write_depth")),
    };
    caster_pair(gpu, "casters", &[wgsl::CASTER, stage].concat(), solid, caster_layout, cull)
}

/// A pass over casters with one matrix, written by hand.
pub(super) fn casters_by_hand(gpu: &Gpu, caster_layout: &wgpu::BindGroupLayout) -> Pair {
    let text = concat!(include_str!("casters.wgsl"), include_str!("casters_by_hand.wgsl"));
    caster_pair(gpu, "casters by hand", text, None, caster_layout, None)
}

/// A caster pair of any text with the entry points `throw_solid`, `throw_cut` and `cut`, and a fragment stage for solid
/// ones.
fn caster_pair(
    gpu: &Gpu,
    label: &'static str,
    text: &str,
    solid: Option<&'static str>,
    layout: &wgpu::BindGroupLayout,
    cull: Option<wgpu::Face>,
) -> Pair {
    pair(
        gpu,
        &PairDescriptor {
            label,
            text: &[text, include_str!("cutout.wgsl")].concat(),
            groups: [Some(layout), None],
            solid: ("throw_solid", solid),
            cut: ("throw_cut", "cut"),
            depth: gpu::depth_stencil_state(),
            target: None,
            cull,
        },
    )
}

/// The camera's depth.
pub(super) fn camera_depth(gpu: &Gpu) -> Pair {
    pair(
        gpu,
        &PairDescriptor {
            label: "camera depth",
            text: STAGE,
            groups: [Some(&camera_layout(gpu.device())), None],
            solid: ("place_depth", None),
            cut: ("place_cut", "cut_depth"),
            depth: camera_depth_state(true),
            target: None,
            cull: None,
        },
    )
}

/// How a receiver's shader is built around its lookup.
#[derive(Clone, Copy)]
pub(super) enum Host {
    /// Looked up at each fragment, from position and normal.
    Whole,
    /// The same, shaded.
    WholeShaded,
    /// Placed at each vertex, sampled at each fragment.
    Placed,
    /// The same, shaded.
    PlacedShaded,
    /// Looked up at each fragment, from a position alone.
    Bare,
}

impl Host {
    /// The laboratory's: in two stages where a fragment takes one sample. Boxes take four and more, which is what they
    /// cost; their lookup stays whole. In warped maps nothing of it is linear in position, and vertices do not know
    /// which of several maps their fragments read.
    pub(super) fn of(key: WgslKey) -> Self {
        match key.filter {
            Pcf::Point | Pcf::Hardware2x2 if key.has_two_stages() => Self::Placed,
            _ => Self::Whole,
        }
    }

    /// The same, shaded.
    pub(super) fn shaded(key: WgslKey) -> Self {
        match Self::of(key) {
            Self::Placed => Self::PlacedShaded,
            _ => Self::WholeShaded,
        }
    }

    /// Its text, and its vertex functions for solid triangles and for triangles with cut-outs.
    fn parts(self) -> (&'static str, [&'static str; 2]) {
        const WHOLE: [&str; 2] = ["place", "place_cut"];
        const OWN: [&str; 2] = ["put", "put_cut"];
        macro_rules! texts {
            ($($file:literal)+) => { concat!($(include_str!($file)),+) };
        }
        match self {
            Self::Whole => (texts!("host_full.wgsl" "host_whole.wgsl" "shade_not.wgsl"), WHOLE),
            Self::WholeShaded => (texts!("host_full.wgsl" "host_whole.wgsl" "shade.wgsl"), WHOLE),
            Self::Placed => (texts!("host_lean.wgsl" "host_placed.wgsl"), OWN),
            Self::PlacedShaded => (texts!("host_full.wgsl" "host_placed_shaded.wgsl" "shade.wgsl"), OWN),
            Self::Bare => (texts!("host_lean.wgsl" "host_bare.wgsl"), OWN),
        }
    }
}

/// The library's receivers as the laboratory draws them.
pub(super) fn receivers(gpu: &Gpu, key: WgslKey) -> Pair {
    library_receivers(gpu, key, Host::of(key))
}

/// The library's receivers in any host.
pub(super) fn library_receivers(gpu: &Gpu, key: WgslKey, host: Host) -> Pair {
    receivers_of(gpu, key, host, &wgsl::module(key, Bindings { group: 1, first: 0 }))
}

/// The library's receivers for a map that is looked up with [`Pcf::Box5x5`], with a box of `taps` bilinear taps to an
/// axis in its place: 2 `taps` − 1 texels wide.
pub(super) fn wide_receivers(gpu: &Gpu, key: WgslKey, taps: u32) -> Pair {
    const FIVE: &str = include_str!("../../../shaders/pcf_box_five.wgsl");
    let any = format!("const BOX_TAPS: i32 = {taps};\n{}", include_str!("pcf_box_any.wgsl"));
    let module = wgsl::module(key, Bindings { group: 1, first: 0 }).replacen(FIVE, &any, 1);
    receivers_of(gpu, key, Host::Whole, &module)
}

fn receivers_of(gpu: &Gpu, key: WgslKey, host: Host, module: &str) -> Pair {
    let placed = if key.has_two_stages() { include_str!("light_placed.wgsl") } else { "" };
    let text = [module, include_str!("light_whole.wgsl"), placed].concat();
    let maps = gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("maps"),
        entries: &gpu::layout_entries(key, 0, wgpu::ShaderStages::VERTEX_FRAGMENT),
    });
    receiver_pair(gpu, "receivers", &text, host, &maps)
}

/// Receivers of any text with the functions that the host calls.
pub(super) fn receiver_pair(
    gpu: &Gpu,
    label: &'static str,
    light: &str,
    host: Host,
    maps: &wgpu::BindGroupLayout,
) -> Pair {
    let (text, [solid, cut]) = host.parts();
    pair(
        gpu,
        &PairDescriptor {
            label,
            text: &[light, STAGE, text].concat(),
            groups: [Some(&camera_layout(gpu.device())), Some(maps)],
            solid: (solid, Some("receive")),
            cut: (cut, "receive_cut"),
            depth: camera_depth_state(false),
            target: Some(MASK_FORMAT),
            cull: None,
        },
    )
}

/// Reversed depth: nearer is greater. Receivers pass where they are what the depth pass left.
fn camera_depth_state(write: bool) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        depth_write_enabled: Some(write),
        depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
        ..gpu::depth_stencil_state()
    }
}

fn pair(gpu: &Gpu, descriptor: &PairDescriptor) -> Pair {
    let device = gpu.device();
    let label = Some(descriptor.label);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label,
        source: wgpu::ShaderSource::Wgsl(descriptor.text.into()),
    });
    let cutout = cutout_layout(device);
    let make = |vertex: &str, fragment: Option<&str>, third: Option<&wgpu::BindGroupLayout>| {
        let [first, second] = descriptor.groups;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[first, second, third],
            immediate_size: 0,
        });
        let target = descriptor.target.map(wgpu::ColorTargetState::from);
        let targets: &[_] = if target.is_some() { &[target] } else { &[] };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &vertex_buffers(),
            },
            // Both sides of every triangle, unless told otherwise: foliage and cloth have no inside.
            primitive: wgpu::PrimitiveState { cull_mode: descriptor.cull, ..Default::default() },
            depth_stencil: Some(descriptor.depth.clone()),
            multisample: wgpu::MultisampleState::default(),
            fragment: fragment.map(|entry_point| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    };
    Pair {
        solid: make(descriptor.solid.0, descriptor.solid.1, None),
        cut: make(descriptor.cut.0, Some(descriptor.cut.1), Some(&cutout)),
    }
}

/// Positions, and all other attributes.
fn vertex_buffers() -> [Option<wgpu::VertexBufferLayout<'static>>; 2] {
    const POSITION: [wgpu::VertexAttribute; 1] =
        [wgpu::VertexAttribute { format: Float32x3, offset: 0, shader_location: 0 }];
    const ATTRIBUTES: [wgpu::VertexAttribute; 2] = [
        wgpu::VertexAttribute { format: Snorm16x4, offset: 0, shader_location: 1 },
        wgpu::VertexAttribute { format: Float32x2, offset: 8, shader_location: 2 },
    ];
    let buffer = |array_stride: usize, attributes| {
        Some(wgpu::VertexBufferLayout {
            array_stride: array_stride as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes,
        })
    };
    [buffer(size_of::<glam::Vec3>(), &POSITION), buffer(size_of::<Attributes>(), &ATTRIBUTES)]
}

/// Group 0 of the camera's passes.
pub(super) fn camera_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entries = [uniform_entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT, false)];
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("camera"), entries: &entries })
}

/// Group 2 of every pass over cut-outs.
pub(super) fn cutout_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT;
    let mask = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let entries = [
        uniform_entry(0, visibility, false),
        wgpu::BindGroupLayoutEntry { binding: 1, visibility, ty: mask, count: None },
        wgpu::BindGroupLayoutEntry { binding: 2, visibility, ty: sampler, count: None },
    ];
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("cut-out"), entries: &entries })
}

/// A uniform buffer's entry.
pub(super) fn uniform_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
    has_dynamic_offset: bool,
) -> wgpu::BindGroupLayoutEntry {
    let ty =
        wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, has_dynamic_offset, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

/// A uniform buffer with contents.
pub(super) fn uniform_buffer(gpu: &Gpu, label: &'static str, bytes: &[u8]) -> wgpu::Buffer {
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue().write_buffer(&buffer, 0, bytes);
    buffer
}
