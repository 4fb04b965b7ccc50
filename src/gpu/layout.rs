//! Bind group layouts, and what is bound there.

use core::num::NonZeroU64;

use super::prefilter::stored_type;
use crate::frame::{MAX_VIEWS, ViewUniforms, WgslKey};
use crate::texel::Texel;

/// Bytes that a caster's vertex shader reads: the matrix, and for warped maps the row of linear depth after it.
pub(super) const CASTER_BYTES: u64 = (size_of::<glam::Mat4>() + size_of::<glam::Vec4>()) as u64;

/// Layout entries that match [`wgsl::module`](crate::wgsl::module) with the same `first`, for a group of the engine's
/// own: uniforms, map (an array of them for several maps), comparison sampler. `antumbra_place` needs them where it is
/// called: vertices as well as fragments.
#[must_use]
pub fn layout_entries(key: WgslKey, first: u32, visibility: wgpu::ShaderStages) -> [wgpu::BindGroupLayoutEntry; 3] {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding: first + binding, visibility, ty, count: None };
    [
        entry(
            0,
            wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: NonZeroU64::new(uniform_bytes(key)),
            },
        ),
        entry(
            1,
            wgpu::BindingType::Texture {
                sample_type: sample_type(key),
                view_dimension: map_dimension(key),
                multisampled: false,
            },
        ),
        entry(2, wgpu::BindingType::Sampler(sampler_type(key))),
    ]
}

/// What shaders of a key read of a texel.
fn sample_type(key: WgslKey) -> wgpu::TextureSampleType {
    match key.texel {
        Texel::Depth => wgpu::TextureSampleType::Depth,
        Texel::Moments(moments) => stored_type(moments),
    }
}

/// How shaders of a key sample the maps.
fn sampler_type(key: WgslKey) -> wgpu::SamplerBindingType {
    match key.texel {
        Texel::Depth => wgpu::SamplerBindingType::Comparison,
        Texel::Moments(moments) if moments.linear => wgpu::SamplerBindingType::Filtering,
        Texel::Moments(_) => wgpu::SamplerBindingType::NonFiltering,
    }
}

/// How shaders of a key see the maps.
pub(super) fn map_dimension(key: WgslKey) -> wgpu::TextureViewDimension {
    if crate::wgsl::is_arrayed(key) { wgpu::TextureViewDimension::D2Array } else { wgpu::TextureViewDimension::D2 }
}

/// Bytes of `AntumbraUniforms` for a key: an array of views.
pub(super) fn uniform_bytes(key: WgslKey) -> u64 {
    (size_of::<ViewUniforms>() * most_views(key)) as u64
}

/// Most views of a key's frames: its maps.
pub(super) fn most_views(key: WgslKey) -> usize {
    usize::from(key.maps).clamp(1, MAX_VIEWS)
}

/// What is bound at [`layout_entries`].
pub(super) fn bind_entries<'a>(
    key: WgslKey,
    first: u32,
    uniforms: &'a wgpu::Buffer,
    view: &'a wgpu::TextureView,
    compare: &'a wgpu::Sampler,
) -> [wgpu::BindGroupEntry<'a>; 3] {
    let block = wgpu::BufferBinding { buffer: uniforms, offset: 0, size: NonZeroU64::new(uniform_bytes(key)) };
    let entry = |binding, resource| wgpu::BindGroupEntry { binding: first + binding, resource };
    [
        entry(0, wgpu::BindingResource::Buffer(block)),
        entry(1, wgpu::BindingResource::TextureView(view)),
        entry(2, wgpu::BindingResource::Sampler(compare)),
    ]
}

/// Layout of [`ShadowMaps::caster_bind_group`](super::ShadowMaps::caster_bind_group), for pipelines that are built
/// before the maps.
#[must_use]
pub fn caster_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("antumbra casters"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: true,
                // Affine maps read the matrix alone, warped maps the depth row too: checked when it is drawn.
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

/// What casters of every view read, one view at a time.
pub(super) fn caster_bind_group(
    device: &wgpu::Device,
    label: Option<&str>,
    layout: &wgpu::BindGroupLayout,
    casters: &wgpu::Buffer,
) -> wgpu::BindGroup {
    let matrix = wgpu::BufferBinding { buffer: casters, offset: 0, size: NonZeroU64::new(CASTER_BYTES) };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label,
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(matrix) }],
    })
}
