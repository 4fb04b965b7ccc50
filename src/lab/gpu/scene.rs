//! A scene on the GPU: triangles without indices, sorted so that equal cut-outs are drawn together.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use super::{Gpu, GpuFailure, pipelines};
use crate::lab::scene::{Cutout, SOLID, SceneModel};
use crate::scene::Aabb;

/// Attributes of a vertex beside its position, which has a buffer of its own: depth passes read nothing else.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Attributes {
    /// Geometric normal of the face, signed normalised, and padding. 16 bits keep it within 3e-5.
    normal: [i16; 4],
    uv: [f32; 2],
}

/// Consecutive vertices of one object with one cut-out.
#[derive(Clone, Debug)]
struct Draw {
    object: usize,
    /// Index of the cut-out, or [`SOLID`].
    cutout: u32,
    vertices: Range<u32>,
}

/// A scene, uploaded.
#[derive(Debug)]
pub struct GpuScene {
    origin: DVec3,
    positions: wgpu::Buffer,
    attributes: wgpu::Buffer,
    draws: Vec<Draw>,
    bounds: Vec<Aabb>,
    cutouts: Vec<wgpu::BindGroup>,
    vertices: u32,
}

/// What a run of draws needs.
pub(super) enum Batch<'a> {
    /// Solid triangles.
    Solid(Range<u32>),
    /// Triangles with a cut-out.
    Cut(&'a wgpu::BindGroup, Range<u32>),
}

impl GpuScene {
    /// Uploads a model. Positions are narrowed to f32 relative to `origin`, which has to be the origin of the frames
    /// that are drawn with it.
    ///
    /// # Errors
    /// An index of the model that points nowhere, a mask of the wrong size, or more than the device can hold.
    pub fn upload(gpu: &Gpu, model: &SceneModel, origin: DVec3) -> Result<Self, GpuFailure> {
        check(model)?;
        // Sort triangles by cut-out, then by object.
        let objects = if model.objects.is_empty() {
            std::iter::once(0..model.triangles.len()).collect()
        } else {
            model.objects.clone()
        };
        let cutout_of = |triangle: usize| model.triangle_cutout.get(triangle).copied().unwrap_or(SOLID);
        let mut order: Vec<(u32, usize, usize)> = objects
            .iter()
            .enumerate()
            .flat_map(|(object, triangles)| triangles.clone().map(move |triangle| (object, triangle)))
            .map(|(object, triangle)| (cutout_of(triangle), object, triangle))
            .collect();
        order.sort_unstable_by_key(|&(cutout, object, triangle)| (cutout.wrapping_add(1), object, triangle));
        // Write vertices and runs.
        let mut positions: Vec<Vec3> = Vec::with_capacity(3 * order.len());
        let mut attributes = Vec::with_capacity(3 * order.len());
        let mut draws: Vec<Draw> = Vec::new();
        for (cutout, object, triangle) in order {
            let start = positions.len() as u32;
            push_triangle(model, triangle, origin, &mut positions, &mut attributes);
            match draws.last_mut() {
                Some(last) if last.object == object && last.cutout == cutout => last.vertices.end = start + 3,
                _ => draws.push(Draw { object, cutout, vertices: start..start + 3 }),
            }
        }
        // Upload.
        let vertices = positions.len() as u32;
        let bounds = objects.iter().map(|triangles| bounds(model, triangles.clone())).collect();
        Ok(Self {
            origin,
            positions: vertex_buffer(gpu, "positions", bytemuck::cast_slice(&positions))?,
            attributes: vertex_buffer(gpu, "attributes", bytemuck::cast_slice(&attributes))?,
            draws,
            bounds,
            cutouts: upload_cutouts(gpu, &model.cutouts)?,
            vertices,
        })
    }

    /// World position of the origin of its render space.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangles(&self) -> u32 {
        self.vertices / 3
    }

    /// World bounds of its objects: what an engine would test with
    /// [`CullVolume::may_cast`](crate::CullVolume::may_cast).
    #[must_use]
    pub fn bounds(&self) -> &[Aabb] {
        &self.bounds
    }

    /// The draws of the objects that pass `keep`, neighbours joined.
    pub(super) fn batches(&self, keep: impl Fn(&Aabb) -> bool) -> Vec<Batch<'_>> {
        let kept: Vec<bool> = self.bounds.iter().map(keep).collect();
        let mut runs: Vec<(u32, Range<u32>)> = Vec::new();
        for draw in self.draws.iter().filter(|draw| kept[draw.object]) {
            match runs.last_mut() {
                Some((cutout, run)) if *cutout == draw.cutout && run.end == draw.vertices.start => {
                    run.end = draw.vertices.end;
                }
                _ => runs.push((draw.cutout, draw.vertices.clone())),
            }
        }
        runs.into_iter()
            .map(|(cutout, run)| match self.cutouts.get(cutout as usize) {
                Some(group) => Batch::Cut(group, run),
                None => Batch::Solid(run),
            })
            .collect()
    }

    /// Draws batches with a pipeline for each kind. Bind groups 0 and 1 are the caller's, 2 is the cut-out's.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass, batches: &[Batch], pipelines: &pipelines::Pair) {
        pass.set_vertex_buffer(0, self.positions.slice(..));
        pass.set_vertex_buffer(1, self.attributes.slice(..));
        let mut is_solid = None;
        for batch in batches {
            let (solid, vertices) = match batch {
                Batch::Solid(vertices) => (true, vertices),
                Batch::Cut(_, vertices) => (false, vertices),
            };
            if is_solid != Some(solid) {
                pass.set_pipeline(if solid { &pipelines.solid } else { &pipelines.cut });
                is_solid = Some(solid);
            }
            if let Batch::Cut(group, _) = batch {
                pass.set_bind_group(2, *group, &[]);
            }
            pass.draw(vertices.clone(), 0..1);
        }
    }
}

/// Every index of the model points somewhere.
fn check(model: &SceneModel) -> Result<(), GpuFailure> {
    let within = |field, value: u64, legal: u64| {
        if value < legal { Ok(()) } else { Err(GpuFailure::Scene { field, value, legal }) }
    };
    let exactly = |field, value: u64, legal: u64| {
        if value == legal { Ok(()) } else { Err(GpuFailure::Scene { field, value, legal }) }
    };
    let (positions, triangles) = (model.positions.len() as u64, model.triangles.len() as u64);
    // Vertex numbers are 32 bits.
    within("scene.triangles.len()", triangles, u64::from(u32::MAX / 3))?;
    for index in model.triangles.iter().flatten() {
        within("scene.triangles", u64::from(*index), positions)?;
    }
    for object in &model.objects {
        within("scene.objects.end", object.end as u64, triangles + 1)?;
    }
    if !model.triangle_cutout.is_empty() {
        exactly("scene.triangle_cutout.len()", model.triangle_cutout.len() as u64, triangles)?;
    }
    if !model.uvs.is_empty() {
        exactly("scene.uvs.len()", model.uvs.len() as u64, positions)?;
    }
    for cutout in model.triangle_cutout.iter().filter(|cutout| **cutout != SOLID) {
        within("scene.triangle_cutout", u64::from(*cutout), model.cutouts.len() as u64)?;
    }
    for cutout in &model.cutouts {
        let texels = u64::from(cutout.width) * u64::from(cutout.height);
        exactly("scene.cutouts.alpha.len()", cutout.alpha.len() as u64, texels)?;
        within("scene.cutouts, texels missing", u64::from(texels == 0), 1)?;
    }
    Ok(())
}

fn push_triangle(
    model: &SceneModel,
    triangle: usize,
    origin: DVec3,
    positions: &mut Vec<Vec3>,
    attributes: &mut Vec<Attributes>,
) {
    let corners = model.triangles[triangle].map(|index| index as usize);
    let [a, b, c] = corners.map(|index| model.positions[index]);
    let normal = (b - a).cross(c - a).normalize_or_zero().extend(0.0) * f64::from(i16::MAX);
    let normal = normal.to_array().map(|component| component.round() as i16);
    for index in corners {
        positions.push((model.positions[index] - origin).as_vec3());
        let uv = model.uvs.get(index).map_or([0.0; 2], |uv| uv.as_vec2().to_array());
        attributes.push(Attributes { normal, uv });
    }
}

fn bounds(model: &SceneModel, triangles: Range<usize>) -> Aabb {
    Aabb::around(model.triangles[triangles].iter().flatten().map(|index| model.positions[*index as usize]))
}

fn vertex_buffer(gpu: &Gpu, label: &'static str, bytes: &[u8]) -> Result<wgpu::Buffer, GpuFailure> {
    let legal = gpu.device().limits().max_buffer_size;
    if bytes.len() as u64 > legal {
        return Err(GpuFailure::Scene { field: "scene.triangles, bytes", value: bytes.len() as u64, legal });
    }
    // An empty buffer cannot be bound: an empty scene keeps one vertex that nothing draws.
    let size = (bytes.len() as u64).max(size_of::<Attributes>() as u64);
    let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
    let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
    let buffer = gpu.device().create_buffer(&descriptor);
    gpu.queue().write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}

/// A texture, a sampler and a cutoff for each mask: the finest level alone, repeated, bilinear.
fn upload_cutouts(gpu: &Gpu, cutouts: &[Cutout]) -> Result<Vec<wgpu::BindGroup>, GpuFailure> {
    let layout = pipelines::cutout_layout(gpu.device());
    let sampler = gpu.device().create_sampler(&wgpu::SamplerDescriptor {
        label: Some("cut-out"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    cutouts.iter().map(|cutout| upload_cutout(gpu, &layout, &sampler, cutout)).collect()
}

fn upload_cutout(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    sampler: &wgpu::Sampler,
    cutout: &Cutout,
) -> Result<wgpu::BindGroup, GpuFailure> {
    let largest = gpu.device().limits().max_texture_dimension_2d;
    let longer = cutout.width.max(cutout.height);
    if longer > largest {
        return Err(GpuFailure::Scene { field: "scene.cutouts.width", value: longer.into(), legal: largest.into() });
    }
    let size = wgpu::Extent3d { width: cutout.width, height: cutout.height, depth_or_array_layers: 1 };
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("cut-out"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(cutout.width), rows_per_image: None };
    gpu.queue().write_texture(texture.as_image_copy(), &cutout.alpha, rows, size);
    let cutoff = pipelines::uniform_buffer(gpu, "cutoff", bytemuck::bytes_of(&[cutout.cutoff, 0.0, 0.0, 0.0]));
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    Ok(gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("cut-out"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: cutoff.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(sampler) },
        ],
    }))
}
