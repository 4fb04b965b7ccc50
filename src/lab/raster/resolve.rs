//! From a pixel back to the surface point it shows.

use glam::{DMat4, DVec2, DVec3, DVec4};
use rayon::prelude::*;

use super::{DepthMode, DepthTarget, NONE};
use crate::lab::scene::SceneModel;

/// The surface point a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Position in render space (world - origin).
    pub position: DVec3,
    /// Geometric normal, unit length, towards the viewer.
    pub normal: DVec3,
    /// Index into [`SceneModel::triangles`].
    pub triangle: u32,
}

/// Finds, for every pixel of `target`, where the ray through its centre meets the triangle drawn there; `None` where
/// nothing was drawn.
///
/// The vertices are those the rasteriser drew (narrowed to `f32` relative to `origin`), the arithmetic is `f64`.
/// A ray that misses its triangle, because the triangle's edge snapped to 1/256 pixel, gets the nearest barycentric
/// coordinates inside, so that every position lies on a surface. `render_from_clip` is the inverse of the matrix the
/// target was drawn with; it may be a perspective one, an orthographic one, reversed, or have an infinite far plane.
#[must_use]
pub fn resolve(target: &DepthTarget, model: &SceneModel, render_from_clip: &DMat4, origin: DVec3) -> Vec<Option<Hit>> {
    let width = target.width as usize;
    let size = [f64::from(target.width), f64::from(target.height)];
    let viewer = Viewer::new(render_from_clip, target.mode);
    target
        .triangle
        .par_iter()
        .enumerate()
        .map(|(pixel, &triangle)| {
            if triangle == NONE {
                return None;
            }
            let (column, row) = ((pixel % width) as f64, (pixel / width) as f64);
            let x = (column + 0.5) / size[0] * 2.0 - 1.0;
            let y = 1.0 - (row + 0.5) / size[1] * 2.0;
            let corners = model.triangles[triangle as usize]
                .map(|vertex| (model.positions[vertex as usize] - origin).as_vec3().as_dvec3());
            let (position, normal) = viewer.meet(DVec2::new(x, y), &corners)?;
            Some(Hit { position, normal, triangle })
        })
        .collect()
}

/// The centre of projection, homogeneous: a point for perspective views, a direction for orthographic ones.
struct Viewer<'a> {
    render_from_clip: &'a DMat4,
    centre: DVec4,
    /// +1 or -1: turns `centre.xyz - point * centre.w` into the direction from the point to the viewer.
    towards: f64,
}

impl<'a> Viewer<'a> {
    fn new(render_from_clip: &'a DMat4, mode: DepthMode) -> Self {
        // Clip (0, 0, 1, 0) is where x = y = w = 0. Growing z leads away from the viewer unless z is reversed.
        let towards = match mode {
            DepthMode::LessEqual => -1.0,
            DepthMode::GreaterEqual => 1.0,
        };
        Self { render_from_clip, centre: render_from_clip.z_axis, towards }
    }

    /// Position and facing normal where the ray through clip `at` meets a triangle; `None` for one without area.
    fn meet(&self, at: DVec2, corners: &[DVec3; 3]) -> Option<(DVec3, DVec3)> {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a).try_normalize()?;
        let plane = normal.extend(-normal.dot(a));

        // Any second point of the ray does; the middle of the depth range is finite for infinite far planes too
        let through = *self.render_from_clip * at.extend(0.5).extend(1.0);
        let met = self.centre * plane.dot(through) - through * plane.dot(self.centre);
        let inside = clamp_to_triangle(met.truncate() / met.w, corners)?;

        let outwards = self.towards * (self.centre.truncate() - inside * self.centre.w);
        Some((inside, if normal.dot(outwards) < 0.0 { -normal } else { normal }))
    }
}

/// Moves a point of the triangle's plane to barycentric coordinates within 0..1; the centroid for a point at infinity.
fn clamp_to_triangle(point: DVec3, corners: &[DVec3; 3]) -> Option<DVec3> {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) / area;
    let weights = DVec3::new(weight(b, c), weight(c, a), weight(a, b));
    if !weights.is_finite() {
        return (area > 0.0).then(|| (a + b + c) / 3.0);
    }
    if weights.min_element() >= 0.0 {
        return Some(point);
    }
    let held = weights.max(DVec3::ZERO);
    Some((a * held.x + b * held.y + c * held.z) / held.element_sum())
}
