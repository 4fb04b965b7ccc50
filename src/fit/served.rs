//! What a map is looked up for, where receivers are found by containment: what it holds and no map before it does.

use arrayvec::ArrayVec;
use glam::{DVec3, Mat4, Vec4};

use crate::frame::{MAX_VIEWS, Select, ShadowFrame, ViewUniforms};

/// What the maps of a frame so far hold, with room for their filters.
pub(crate) struct Held {
    /// Half-spaces of render space for each map: its four sides, and the end of its depths. A point in all of them is
    /// looked up there (`antumbra_room`).
    maps: ArrayVec<(Mat4, Vec4), MAX_VIEWS>,
}

impl Held {
    /// By the maps before the next one; `None` where receivers are found by depth, or there is one map.
    pub(crate) fn by(frame: &ShadowFrame) -> Option<Self> {
        let found = frame.wgsl.maps > 1 && frame.wgsl.select == Select::Finest;
        let laid = &frame.uniforms.views[..frame.views.len()];
        found.then(|| Self { maps: laid.iter().map(half_spaces).collect() })
    }

    /// Whether one of them holds a point of render space.
    pub(crate) fn holds(&self, at: DVec3) -> bool {
        let at = at.as_vec3().extend(1.0);
        self.maps.iter().any(|(sides, end)| (*sides * at).cmpge(Vec4::ZERO).all() && end.dot(at) >= 0.0)
    }
}

/// A point within two opposite sides is before the horizon, because maps are wider than their filters.
fn half_spaces(view: &ViewUniforms) -> (Mat4, Vec4) {
    let row = Vec4::from_array;
    let (u, v, w) = (row(view.u_from_render), row(view.v_from_render), row(view.w_from_render));
    let ([left, top, right, bottom], room) = (view.rect, view.domain[2]);
    let [left, right] = [u - w * (left + room), w * (right - room) - u];
    let [top, bottom] = [v - w * (top + room), w * (bottom - room) - v];
    (Mat4::from_cols(left, right, top, bottom).transpose(), Vec4::W - row(view.depth_from_render))
}
