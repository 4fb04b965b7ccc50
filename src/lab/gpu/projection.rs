//! A projection with reversed depth: 1 at the near plane, 0 at the far plane or at infinity.
//!
//! f32 has its finest steps near 0, and a perspective its coarsest far away: reversed, they cancel.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, DVec4, Mat4, Vec4};

use crate::camera::{Camera, Projection};

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
        let view_from_world = camera.world_from_view.inverse();
        let view_from_render = view_from_world * DMat4::from_translation(origin);
        let eye = match camera.projection {
            Projection::Perspective { .. } => (camera.eye() - origin).extend(1.0),
            Projection::Orthographic { .. } => (-camera.forward()).extend(0.0),
        };
        Self {
            clip_from_render: (clip_from_view(&camera.projection) * view_from_render).as_mat4(),
            eye: eye.as_vec4(),
            view_depth: (-view_from_render.row(2)).as_vec4(),
        }
    }
}

/// Clip space with x, y in [−1, 1] and reversed depth.
fn clip_from_view(projection: &Projection) -> DMat4 {
    let rows = match *projection {
        Projection::Perspective { left, right, down, up, near, far } => {
            // Depth near · (far − ζ) / (ζ · (far − near)); its limit for an infinite far is near / ζ.
            let (along, constant) =
                if far.is_finite() { (near / (far - near), near * far / (far - near)) } else { (0.0, near) };
            [
                DVec4::new(2.0 / (right - left), 0.0, (right + left) / (right - left), 0.0),
                DVec4::new(0.0, 2.0 / (up - down), (up + down) / (up - down), 0.0),
                DVec4::new(0.0, 0.0, along, constant),
                DVec4::new(0.0, 0.0, -1.0, 0.0),
            ]
        }
        Projection::Orthographic { left, right, down, up, near, far } => [
            DVec4::new(2.0 / (right - left), 0.0, 0.0, -(right + left) / (right - left)),
            DVec4::new(0.0, 2.0 / (up - down), 0.0, -(up + down) / (up - down)),
            DVec4::new(0.0, 0.0, 1.0 / (far - near), far / (far - near)),
            DVec4::new(0.0, 0.0, 0.0, 1.0),
        ],
    };
    DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ClipDepth;

    /// The library's own recogniser reads the planes back.
    #[test]
    fn planes_survive() {
        let far_planes = [100.0, f64::INFINITY];
        let perspectives = far_planes.map(|far| Projection::Perspective {
            left: -0.3,
            right: 0.5,
            down: -0.4,
            up: 0.2,
            near: 0.25,
            far,
        });
        let box_ = Projection::Orthographic { left: -3.0, right: 5.0, down: -4.0, up: 2.0, near: 1.0, far: 9.0 };
        for projection in perspectives.into_iter().chain([box_]) {
            let read =
                Camera::from_matrices(DMat4::IDENTITY, clip_from_view(&projection), ClipDepth::ZeroToOne).unwrap();
            let (sides, expected) = (format!("{:.9?}", read.projection), format!("{projection:.9?}"));
            assert_eq!(sides, expected);
        }
    }
}
