//! What the laboratory's camera passes read.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, Vec4};

use crate::camera::{Camera, Projection};
use crate::lab::projection::{clip_from_render, view_from_render};

/// What the camera's shaders read; the layout equals `Camera` in `stage.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CameraUniforms {
    clip_from_render: Mat4,
    /// The eye with w = 1, or the direction to the viewer with w = 0.
    eye: Vec4,
    /// A row: eye depth of a render-space position.
    view_depth: Vec4,
}

impl CameraUniforms {
    /// In f64, narrowed once, relative to `origin`.
    pub(super) fn of(camera: &Camera, origin: DVec3) -> Self {
        let view_from_render = view_from_render(camera, origin);
        let eye = match camera.projection {
            Projection::Perspective { .. } => (camera.eye() - origin).extend(1.0),
            Projection::Orthographic { .. } => (-camera.forward()).extend(0.0),
        };
        Self {
            clip_from_render: clip_from_render(camera, origin).as_mat4(),
            eye: eye.as_vec4(),
            view_depth: (-view_from_render.row(2)).as_vec4(),
        }
    }
}
