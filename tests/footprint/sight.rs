//! The Jacobian without its formula: rays through neighbouring pixels.

use antumbra::{Camera, Projection, ViewUniforms};
use glam::{DVec2, DVec3, DVec4, Vec4};

/// Where a ray through the picture meets the plane of a receiver, relative to the point that is looked at.
pub(crate) struct Sight {
    from_eye: DVec3,
    normal: DVec3,
    axes: [DVec3; 3],
    spreads: bool,
}

impl Sight {
    pub(crate) fn new(camera: &Camera, origin: DVec3, position: DVec3, normal: DVec3) -> Self {
        let axes = [camera.world_from_view.x_axis, camera.world_from_view.y_axis, -camera.world_from_view.z_axis];
        let spreads = matches!(camera.projection, Projection::Perspective { .. });
        Self { from_eye: position - (camera.eye() - origin), normal, axes: axes.map(DVec4::truncate), spreads }
    }

    /// The ray that is `off` the one through the point: tangents, or world units of an orthographic camera.
    pub(crate) fn meet(&self, off: DVec2) -> DVec3 {
        let [right, up, forward] = self.axes;
        let depth = self.from_eye.dot(forward);
        let aside = right * off.x + up * off.y;
        if self.spreads {
            // The point is at depth times its own ray.
            let ray = self.from_eye / depth + aside;
            let farther = -depth * self.normal.dot(aside) / self.normal.dot(ray);
            (self.from_eye / depth) * farther + aside * (depth + farther)
        } else {
            aside - forward * (self.normal.dot(aside) / self.normal.dot(forward))
        }
    }
}

/// Texels between the places in the map of a point and of one `step` away: no difference of large numbers.
fn texels(view: &ViewUniforms, side: u32, position: DVec3, step: DVec3) -> DVec2 {
    let [u, v, w] = [view.u_from_render, view.v_from_render, view.w_from_render].map(|row| Vec4::from(row).as_dvec4());
    let (at, before) = (position.extend(1.0), w.dot(position.extend(1.0)));
    let after = before + w.truncate().dot(step);
    let moved = |row: DVec4| (row - w * (row.dot(at) / before)).truncate().dot(step) / after;
    DVec2::new(moved(u), moved(v)) * f64::from(side)
}

/// Share of itself by which anything may change over a step of the stencil: its fourth power is the error, 1e-16 over
/// it the rounding.
const STEP: f64 = 2e-4;

/// J by the five-point stencil along both axes of the picture; `None` where the surface is all but seen from its edge.
pub(crate) fn differences(
    view: &ViewUniforms,
    side: u32,
    camera: &Camera,
    position: DVec3,
    sight: &Sight,
) -> Option<[DVec2; 2]> {
    let [_, _, forward] = sight.axes;
    let ray = if sight.spreads { sight.from_eye / sight.from_eye.dot(forward) } else { forward };
    let facing = sight.normal.dot(ray).abs();
    let (pixel, depth) = (pixel_size(camera), if sight.spreads { sight.from_eye.dot(forward) } else { 1.0 });
    let w = Vec4::from(view.w_from_render).as_dvec4();
    // Neither the cosine nor w may change by more than the share.
    let reach = depth * (1.0 + ray.length() / facing);
    let by_w = w.dot(position.extend(1.0)) / (w.truncate().length() * reach).max(1e-300);
    let step = STEP * facing.min(by_w).min((pixel * camera.viewport.as_dvec2()).max_element());
    (facing > 1e-6).then(|| {
        [DVec2::X, DVec2::Y].map(|axis| {
            let at = |times: f64| texels(view, side, position, sight.meet(axis * (step * times)));
            let slope = ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * step);
            slope * axis.dot(pixel)
        })
    })
}

/// What rounding in f64 does to the gradients of a map, texels per world unit: places in it are differences of numbers
/// that grow with the distance from the origin.
pub(crate) fn doubt(view: &ViewUniforms, side: u32, position: DVec3) -> f64 {
    let [u, v, w] = [view.u_from_render, view.v_from_render, view.w_from_render].map(|row| Vec4::from(row).as_dvec4());
    let (at, size) = (w.dot(position.extend(1.0)), position.extend(1.0).abs());
    let of =
        |row: DVec4| row.truncate().length() + w.truncate().length() * (row.abs().dot(size) + w.abs().dot(size)) / at;
    8.0 * f64::EPSILON * of(u).max(of(v)) * f64::from(side) / at
}

/// Size of a pixel: tangents, or world units of an orthographic camera.
pub(crate) fn pixel_size(camera: &Camera) -> DVec2 {
    let size = match camera.projection {
        Projection::Perspective { left, right, down, up, .. }
        | Projection::Orthographic { left, right, down, up, .. } => DVec2::new(right - left, up - down),
    };
    size / camera.viewport.as_dvec2()
}

/// Least and largest singular value, and the determinant.
pub(crate) fn singular([x, y]: [DVec2; 2]) -> (f64, f64, f64) {
    let (sum, difference) = ((x - y.perp()).length(), (x + y.perp()).length());
    (0.5 * (sum - difference).abs(), 0.5 * (sum + difference), x.perp_dot(y).abs())
}
