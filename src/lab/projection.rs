//! The laboratory's own camera projection, with reversed depth: 1 at the near plane, 0 at the far plane or at infinity.
//!
//! f32 has its finest steps near 0, and a perspective its coarsest far away: reversed, they cancel.

use glam::{DMat4, DVec3, DVec4};

use crate::camera::{Camera, Projection};

/// Render space (world − `origin`) to the camera's clip space, reversed depth, in f64.
#[must_use]
pub fn clip_from_render(camera: &Camera, origin: DVec3) -> DMat4 {
    clip_from_view(&camera.projection) * view_from_render(camera, origin)
}

/// Render space (world − `origin`) to view space, in f64.
#[must_use]
pub fn view_from_render(camera: &Camera, origin: DVec3) -> DMat4 {
    // Eye and origin are subtracted before anything is rotated: far from the world's origin they nearly cancel.
    let mut view_from_eye = camera.world_from_view;
    view_from_eye.w_axis = DVec4::W;
    view_from_eye.transpose() * DMat4::from_translation(origin - camera.eye())
}

/// Clip space with x, y in [−1, 1] and reversed depth, from view space.
#[must_use]
pub fn clip_from_view(projection: &Projection) -> DMat4 {
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
