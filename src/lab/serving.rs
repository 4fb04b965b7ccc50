//! Which of a frame's maps serves a point: the choice that the shaders make, for what measures maps one by one.

use glam::DVec3;

use crate::camera::Camera;
use crate::encoding::depth::antumbra_look;
use crate::encoding::split::{antumbra_index, antumbra_room};
use crate::frame::{MAX_VIEWS, Select, ShadowFrame};

/// The view of a frame that serves a point of a receiver with a normal, both in render space around `origin`.
///
/// One map serves everything. Of several, as the frame's key selects: the one whose depths hold the point's eye depth, or
/// the first one that holds the point and what its filter reads. Where two are blended, it is the nearer or the finer one.
/// `None` where no view serves it: there it reads lit.
#[must_use]
pub fn serving(frame: &ShadowFrame, camera: &Camera, origin: DVec3, position: DVec3, normal: DVec3) -> Option<usize> {
    let (key, views) = (frame.wgsl, frame.views.len());
    let last = usize::from(key.maps).clamp(1, MAX_VIEWS) - 1;
    let index = match key.select {
        _ if last == 0 => 0,
        Select::Depth => antumbra_index(&frame.uniforms, last, camera.eye_depth(position, origin) as f32),
        Select::Finest => {
            let (position, normal) = (position.as_vec3(), normal.as_vec3());
            let holds = |view| antumbra_room(key, view, &antumbra_look(key, view, position, normal)) >= 0.0;
            frame.uniforms.views[..views].iter().position(holds)?
        }
    };
    (index < views).then_some(index)
}
