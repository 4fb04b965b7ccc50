//! From the GPU to memory.

use glam::{UVec2, UVec4, Vec4};
use half::f16;

use super::{Gpu, GpuFailure};
use crate::gpu::ShadowMaps;
use crate::texel::{MomentFormat, Moments, Texel};

/// The contents of the map on a layer, the last one for layers that there are not: depths row by row, row 0 on top.
///
/// # Errors
/// The device failed.
pub fn read_depth(gpu: &Gpu, maps: &ShadowMaps, layer: u32) -> Result<Vec<f32>, GpuFailure> {
    let size = UVec2::splat(maps.depth_texture().width());
    let layer = layer.min(maps.layers() - 1);
    let bytes = read_layer(gpu, maps.depth_texture(), layer, size, size_of::<f32>() as u32)?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

/// What a level of a layer of filtered maps stores, row by row, row 0 on top; numbers that a texel has not are 0. A
/// series has [`Moments::layers`] layers for each map. Nothing for maps of depths; the last layer and level for those
/// that there are not.
///
/// # Errors
/// The device failed.
pub fn read_moments(gpu: &Gpu, maps: &ShadowMaps, layer: u32, level: u32) -> Result<Vec<Vec4>, GpuFailure> {
    let (Texel::Moments(moments), Some(texture)) = (maps.key().texel, maps.moments_texture()) else {
        return Ok(Vec::new());
    };
    let layer = layer.min(texture.depth_or_array_layers() - 1);
    let level = level.min(texture.mip_level_count() - 1);
    let size = UVec2::splat((texture.width() >> level).max(1));
    let texel_bytes = moments.bytes() / moments.layers();
    let bytes = read_level(gpu, texture, (layer, level), size, texel_bytes)?;
    Ok(bytes.chunks_exact(texel_bytes as usize).map(|texel| numbers(moments, texel)).collect())
}

/// The sums that a layer of summed maps stores, row by row, row 0 on top; numbers that a texel has not are 0. Nothing
/// for other maps; the last layer for those that there are not.
///
/// # Errors
/// The device failed.
pub fn read_sums(gpu: &Gpu, maps: &ShadowMaps, layer: u32) -> Result<Vec<UVec4>, GpuFailure> {
    let Some(texture) = maps.moments_texture() else { return Ok(Vec::new()) };
    let Texel::Moments(moments) = maps.key().texel else { return Ok(Vec::new()) };
    if !moments.is_summed() {
        return Ok(Vec::new());
    }
    let layer = layer.min(texture.depth_or_array_layers() - 1);
    let bytes = read_layer(gpu, texture, layer, UVec2::splat(texture.width()), moments.bytes())?;
    let whole = |texel: &[u8]| {
        let mut numbers = [0; 4];
        bytemuck::cast_slice_mut(&mut numbers)[..texel.len()].copy_from_slice(texel);
        UVec4::from_array(numbers)
    };
    Ok(bytes.chunks_exact(moments.bytes() as usize).map(whole).collect())
}

/// The numbers of a texel.
fn numbers(moments: Moments, texel: &[u8]) -> Vec4 {
    let size = moments.format().bits() as usize / 8;
    let mut numbers = [0.0; 4];
    for (number, bytes) in numbers.iter_mut().zip(texel.chunks_exact(size)) {
        *number = match (moments.format(), bytes) {
            (MomentFormat::Float32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
            (MomentFormat::Float16, &[a, b]) => f16::from_le_bytes([a, b]).to_f32(),
            (MomentFormat::Summed, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]) as f32,
            (MomentFormat::Unorm16, &[a, b]) => f32::from(u16::from_le_bytes([a, b])) / f32::from(u16::MAX),
            (_, bytes) => f32::from(bytes[0]) / f32::from(u8::MAX),
        };
    }
    Vec4::from_array(numbers)
}

/// Bytes of a texture's layer, rows packed.
pub(super) fn read_layer(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    layer: u32,
    size: UVec2,
    texel_bytes: u32,
) -> Result<Vec<u8>, GpuFailure> {
    read_level(gpu, texture, (layer, 0), size, texel_bytes)
}

fn read_level(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    (layer, mip_level): (u32, u32),
    size: UVec2,
    texel_bytes: u32,
) -> Result<Vec<u8>, GpuFailure> {
    // Copy, with rows padded as the API wants them.
    let row = size.x * texel_bytes;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(padded) * u64::from(size.y),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
            mip_level,
            ..texture.as_image_copy()
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
        },
        wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
    );
    gpu.queue().submit([encoder.finish()]);
    // Drop the padding.
    let bytes = map(gpu, &buffer)?;
    Ok(bytes.chunks_exact(padded as usize).flat_map(|line| &line[..row as usize]).copied().collect())
}

/// The bytes of a buffer that can be mapped.
pub(super) fn map(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuFailure> {
    buffer.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.wait()?;
    let bytes = buffer.get_mapped_range(..).map_err(GpuFailure::device)?.to_vec();
    buffer.unmap();
    Ok(bytes)
}
