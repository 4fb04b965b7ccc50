//! What a map is looked up for, where receivers are found by containment: what it holds and no map before it does.

use arrayvec::ArrayVec;
use glam::{DVec3, DVec4};

use crate::frame::{MAX_VIEWS, Select, ShadowFrame, ViewUniforms};

/// What the maps of a frame so far hold, with room for their filters.
pub(crate) struct Held {
    /// Half-spaces of render space for each map: its four sides, and the end of its depths. A point in all of them is
    /// looked up there (`antumbra_room`).
    maps: ArrayVec<[DVec4; 5], MAX_VIEWS>,
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
        let at = at.extend(1.0);
        self.maps.iter().any(|sides| sides.iter().all(|side| side.dot(at) >= 0.0))
    }
}

/// Before the horizon, w > 0, because each side is positive by itself: two that are opposite are not both beyond it.
fn half_spaces(view: &ViewUniforms) -> [DVec4; 5] {
    let row = |row: [f32; 4]| DVec4::from_array(row.map(f64::from));
    let (u, v, w) = (row(view.u_from_render), row(view.v_from_render), row(view.w_from_render));
    let [left, top, right, bottom] = view.rect.map(f64::from);
    let room = f64::from(view.domain[2]);
    [
        u - w * (left + room),
        w * (right - room) - u,
        v - w * (top + room),
        w * (bottom - room) - v,
        DVec4::W - row(view.depth_from_render),
    ]
}
