//! What maps are made of on a device: the depth texture and its layers, the sampler, the uniforms.

use super::DEPTH_FORMAT;
use crate::frame::{MAX_VIEWS, ShadowUniforms, ViewUniforms, WgslKey};
use crate::texel::Texel;

/// `COPY_SRC` costs nothing and lets engines and tests read the map back.
pub(super) fn depth_texture(device: &wgpu::Device, label: Option<&str>, side: u32, layers: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label,
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// One layer, to be drawn into.
pub(super) fn attachment(texture: &wgpu::Texture, label: Option<&str>, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label,
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// Bilinear comparison: lit where the receiver is not farther than the texel. Moments are interpolated, between levels
/// too, where their format allows it.
pub(super) fn sampler(label: Option<&str>, key: WgslKey) -> wgpu::SamplerDescriptor<'_> {
    let linear = !matches!(key.texel, Texel::Moments(moments) if !moments.linear);
    let filter = if linear { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
    wgpu::SamplerDescriptor {
        label,
        address_mode_u: wgpu::AddressMode::ClampToEdge,
        address_mode_v: wgpu::AddressMode::ClampToEdge,
        address_mode_w: wgpu::AddressMode::ClampToEdge,
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: if linear { wgpu::MipmapFilterMode::Linear } else { wgpu::MipmapFilterMode::Nearest },
        compare: (key.texel == Texel::Depth).then_some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    }
}

/// A uniform buffer in which nothing is shadowed.
pub(super) fn lit_uniforms(device: &wgpu::Device, label: Option<&str>) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label,
        size: size_of::<ShadowUniforms>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: true,
    });
    let lit = ShadowUniforms { views: [ViewUniforms::LIT; MAX_VIEWS], counts: [0; 4] };
    // A buffer mapped at creation is mapped; a lost device leaves it unwritten, and draws nothing anyway.
    if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        mapped.copy_from_slice(bytemuck::bytes_of(&lit));
    }
    buffer.unmap();
    buffer
}
