//! Clears the tile of one map in a layer that it shares with others.

use glam::UVec4;

/// Draws one triangle over a tile, at the farthest depth.
#[derive(Debug)]
pub(super) struct TileClear(wgpu::RenderPipeline);

impl TileClear {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        let label = Some("antumbra clear");
        let source = wgpu::ShaderSource::Wgsl(include_str!("../../shaders/clear.wgsl").into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor { label, ..Default::default() });
        Self(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("antumbra_clear"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                depth_compare: Some(wgpu::CompareFunction::Always),
                ..super::depth_stencil_state()
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        }))
    }

    /// Clears a tile of the layer that a pass draws into.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass, tile: UVec4) {
        limit_to(pass, tile);
        pass.set_pipeline(&self.0);
        pass.draw(0..3, 0..1);
    }
}

/// Lets a pass draw into a rectangle of texels (x, y, width, height) alone.
pub(super) fn limit_to(pass: &mut wgpu::RenderPass, rectangle: UVec4) {
    let [x, y, width, height] = rectangle.as_vec4().to_array();
    pass.set_viewport(x, y, width, height, 0.0, 1.0);
    pass.set_scissor_rect(rectangle.x, rectangle.y, rectangle.z, rectangle.w);
}

/// A view's tile: its viewport and the texel around it that stays clear, inside a layer.
pub(super) fn tile_of(viewport: UVec4, side: u32) -> UVec4 {
    let [left, top] = [viewport.x, viewport.y].map(|start| start.saturating_sub(1));
    let end = |start: u32, length: u32| start.saturating_add(length).saturating_add(1).min(side);
    UVec4::new(
        left,
        top,
        end(viewport.x, viewport.z).saturating_sub(left),
        end(viewport.y, viewport.w).saturating_sub(top),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_have_a_ring_inside_their_layer() {
        assert_eq!(tile_of(UVec4::new(1, 1, 510, 510), 512), UVec4::new(0, 0, 512, 512));
        assert_eq!(tile_of(UVec4::new(257, 1, 254, 254), 512), UVec4::new(256, 0, 256, 256));
        assert_eq!(tile_of(UVec4::new(0, 0, 2, 2), 2), UVec4::new(0, 0, 2, 2));
        let hostile = tile_of(UVec4::splat(u32::MAX), 512);
        assert!(hostile.x + hostile.z >= hostile.x && hostile.z == 0);
    }
}
