//! Perspective shadow maps: the map as the light sees the scene in the camera's post-perspective space.
//!
//! There directional light is a point ℓ' = M (L, 0) on the plane z = f/(f − n), and the map a view from it of the unit
//! cube. In the form with strength, which has no singularity when the light crosses the eye plane (ℓ'_w = 0):
//!
//! ```text
//! (1)  a = (ℓ'_xyz − ℓ'_w g) / |ℓ'_xyz − ℓ'_w g|,   κ' = ℓ'_w / |ℓ'_xyz − ℓ'_w g|,   g the centre of the cube
//! (2)  W = w (1 − κ' (x/w − g) · a)                  (x, w) = M (p, 1)
//! ```
//!
//! κ' < 0 is the inverted light (behind the viewer): W stays what it is, and depth, which is kept apart, keeps its
//! order. W is linear in space and does not change along the light, so that it is *the* warp of this crate with another
//! strength and axis; what remains of the perspective map is affine, and is fitted to the body like every other.
//!
//! # Where this differs from print
//! - TH-8, TH-9: M and L' multiply in the order of column vectors, and a vertex goes through L', not its inverse.
//! - Depth is linear along the light, so that casters behind the eye need no pull-back to keep their order. `pull_back`
//!   is the paper's means to weaken the warp.
//!
//! # References
//! - Stamminger & Drettakis, *Perspective shadow maps*, 2002.
//! - Kozlov, *Perspective shadow maps: care and feeding*, 2004: inverted light, the unit-cube view.
//! - `MATH.md` section 3; section 10 row 18.

use glam::{DVec2, DVec3, DVec4};

use super::sight::{Choice, Sight};
use crate::camera::{Camera, Projection};
use crate::math::homography::WarpFrame;

/// ℓ' of directional light with `towards` pointing to it, in view space, for a frustum given by its tangents.
///
/// Homogeneous: (x, y, z, w) with z ∈ [0, 1] from near to far. w > 0: in front of the viewer; w < 0: behind (inverted).
#[must_use]
pub fn post_perspective_light(sides: [f64; 4], near: f64, far: f64, towards: DVec3) -> DVec4 {
    let row = camera_rows(sides, near, far - near, 0.0);
    DVec4::from_array(row.map(|row| row.dot(towards.extend(0.0))))
}

/// Rows of M over view space: a frustum (left, right, down, up tangents) to the cube [−1, 1]² × [0, 1].
///
/// The frustum begins `near` before the eye, is `depth` long, and its apex is `back` behind the eye; written so that
/// nothing cancels where `back` is far larger than the frustum.
fn camera_rows([left, right, down, up]: [f64; 4], near: f64, depth: f64, back: f64) -> [DVec4; 4] {
    let (width, height) = (right - left, up - down);
    let (aside, above) = ((right + left) / width, (up + down) / height);
    let scale = (near + depth + back) / depth;
    [
        DVec4::new(2.0 / width, 0.0, aside, -aside * back),
        DVec4::new(0.0, 2.0 / height, above, -above * back),
        DVec4::new(0.0, 0.0, -scale, -scale * near),
        DVec4::new(0.0, 0.0, -1.0, back),
    ]
}

/// Centre of the cube.
const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 0.5);

/// The published warp of what is in view, the eye pulled back by `pull_back` world units (not negative). Uniform for
/// orthographic cameras, whose post-perspective space is affine.
pub(crate) fn choose(camera: &Camera, sight: &Sight, pull_back: f64) -> Choice {
    let uniform = Choice { frame: sight.frame, strength: 0.0 };
    let Projection::Perspective { left, right, down, up, .. } = camera.projection else { return uniform };
    // The frustum between the depths of the body, from the pulled-back eye, wide enough for the old one.
    let (nearest, farthest) = sight.depth_range();
    if !(nearest < farthest) {
        return uniform;
    }
    let narrower = farthest / (farthest + pull_back);
    let sides = [left, right, down, up].map(|tangent| tangent * narrower);
    let rows = camera_rows(sides, nearest, farthest - nearest, pull_back);
    // (1) and (2) as a linear function of view space.
    let rotate = |vector: DVec3| camera.world_from_view.transpose().transform_vector3(vector);
    let towards = -rotate(sight.light.travel());
    let light = DVec4::from_array(rows.map(|row| row.dot(towards.extend(0.0))));
    let from_centre = light.truncate() - light.w * CENTRE;
    let distance = from_centre.length();
    let (axis, kappa) = (from_centre / distance, light.w / distance);
    let [x, y, z, w] = rows;
    let slope = x * axis.x + y * axis.y + z * axis.z - w * axis.dot(CENTRE);
    let function = w - slope * kappa;
    // Its gradient across the light, and its value on the top line.
    let gradient =
        DVec2::new(function.truncate().dot(rotate(sight.light.p())), function.truncate().dot(rotate(sight.light.q())));
    let frame = WarpFrame::around(gradient, sight.eye, &sight.points);
    let at_top = function.w + gradient.dot(frame.top - sight.eye);
    // At or behind the centre of projection: as strong as it gets.
    let strength = if at_top > 0.0 { gradient.length() * frame.extent / at_top } else { f64::INFINITY };
    if strength.is_nan() { uniform } else { Choice { frame, strength } }
}
