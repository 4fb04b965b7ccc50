//! The ideal lookup: what a shadow map with a given grid of texels and a given filter shows when nothing else is in its
//! way.
//!
//! Each texel that a filter reads answers for the light ray through its centre, and is asked about the point at which
//! that ray crosses the plane of the receiver's own triangle: in shadow where something lies between that point and the
//! light. There is no rasteriser, no rounding of depths and no bias; a plane never shadows itself. What such a mask
//! still has of false shadow and leaks comes from the grid and the filter alone.
//!
//! It is a yardstick, not a bound: a technique that compares with another point than the plane's (a lifted one, say)
//! trades false shadow for leaks, and may have less of one of them. Where a wall meets the ground, its plane runs on
//! below, and the bare plane is a poor thing to ask about; [`Compare`] has others.
//!
//! # References
//! - Dou, Yan, Kerzner, Dai & Wyman, *Adaptive depth bias for shadow maps*, I3D 2014 (comparing with the receiver's
//!   plane at the texel's centre).

use std::collections::HashMap;

use glam::{DVec2, DVec3, DVec4, I64Vec2, Vec4};
use rayon::prelude::*;

use super::bvh::{Bvh, Ray};
use super::case::{Case, CaseLight};
use super::serving::serving;
use super::subject::Setting;
use super::truth::Truth;
use crate::camera::Camera;
use crate::frame::{Pcf, ShadowFrame};

/// How high above a receiver's plane a shadow ray starts, as a part of the scene's radius. The points of a plane beyond
/// its triangle lie on its neighbours' planes only up to what f32 files leave of flatness (6·10⁻⁸ of a coordinate):
/// less lets flat ground of many triangles shadow itself, more does not see what lies flat on the ground.
const PLANE_SLACK: f64 = 1e-6;

/// Points along a side of the grid that [`Oracle::lit_around`] traces: from one texel before a receiver to one after
/// it, in steps of half a texel.
const AROUND_SIDE: i32 = 5;

/// Number of points that [`Oracle::lit_around`] traces.
pub const AROUND: u32 = (AROUND_SIDE * AROUND_SIDE) as u32;

/// Rows of the picture that one thread owns: neighbours ask the same texels about the same planes.
const BAND_ROWS: usize = 16;

/// The receivers of one case, and rays to its light.
pub struct Oracle<'s> {
    bvh: &'s Bvh<'s>,
    travel: DVec3,
    camera: Camera,
    width: usize,
    /// Per pixel; `None` where the truth is not valid.
    receivers: Vec<Option<Receiver>>,
}

/// What one pixel shows.
#[derive(Clone, Copy)]
struct Receiver {
    /// World space, on the plane of the triangle.
    position: DVec3,
    /// Unit length, towards the light.
    normal: DVec3,
    triangle: u32,
}

/// The texels of one of a frame's views: texture coordinates in units of texels, from world positions.
#[derive(Clone, Copy)]
struct Grid {
    /// Number of the view.
    view: usize,
    /// Rows over render space.
    u: DVec4,
    v: DVec4,
    origin: DVec3,
    /// Texels that are drawn: first ones, and one beyond the last.
    low: I64Vec2,
    high: I64Vec2,
}

/// How the grid lies on a receiver's plane.
struct Tilt {
    /// Texture coordinates of the receiver, texels.
    at: DVec2,
    /// Steps along the plane over one texel in u and in v, world units.
    along_u: DVec3,
    along_v: DVec3,
    /// Distance to the farthest point of the plane within one texel along u and v, world units.
    reach: f64,
}

/// What a texel is asked about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compare {
    /// The point at which its light ray crosses the receiver's plane,
    /// even where the plane runs on below other surfaces.
    Plane,
    /// That point, or where its ray is as far from the light as the receiver, whichever is nearer to the light: what is
    /// below the receiver itself does not shade it.
    Nearer,
    /// The surface nearest to that point along the ray.
    Surface,
}

impl<'s> Oracle<'s> {
    /// Finds the receivers of a case from its truth; `None` unless the light is directional,
    /// as maps with w = 1 need it.
    #[must_use]
    pub fn new(case: &Case, truth: &Truth, bvh: &'s Bvh<'s>) -> Option<Self> {
        let CaseLight::Directional { travel } = case.light else { return None };
        let world_from_view = case.world_from_view();
        let [left, right, lower, upper] = case.tangents();
        let (width, eye) = (truth.width as usize, case.camera.eye);
        let receiver = |pixel: usize| {
            // Meet the plane of the triangle that the pixel's centre shows.
            let (x, y) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
            let across = left + (right - left) * x / f64::from(truth.width);
            let up = upper + (lower - upper) * y / f64::from(truth.height);
            let direction = world_from_view.transform_vector3(DVec3::new(across, up, -1.0));
            let triangle = truth.triangle[pixel];
            let [a, b, c] = bvh.scene().corners(triangle as usize);
            let normal = (b - a).cross(c - a).try_normalize()?;
            let position = eye + direction * (normal.dot(a - eye) / normal.dot(direction));
            let normal = if normal.dot(travel) > 0.0 { -normal } else { normal };
            position.is_finite().then_some(Receiver { position, normal, triangle })
        };
        let pixels = 0..truth.valid.len();
        let receivers = pixels.into_par_iter().map(|pixel| truth.valid[pixel].then(|| receiver(pixel))?).collect();
        Some(Self { bvh, travel, camera: Setting::of(case).camera, width, receivers })
    }

    /// The mask of an ideal lookup in a frame, which was fitted with its render space at `origin`: 0 (shadow) to 1
    /// (light), row 0 on top; 1 where the truth is not valid, and where no view serves. Each receiver is looked up in
    /// one view: nothing is blended.
    #[must_use]
    pub fn mask(&self, frame: &ShadowFrame, origin: DVec3, compare: Compare) -> Vec<f32> {
        let filter = frame.wgsl.filter;
        let band = |receivers: &[Option<Receiver>]| -> Vec<f32> {
            let mut known = HashMap::new();
            let mut lit = |receiver: &Receiver| {
                let grid = self.grid(receiver, frame, origin)?;
                Some(self.look_up(receiver, &grid, filter, compare, &mut known) as f32)
            };
            receivers.iter().map(|receiver| receiver.as_ref().and_then(&mut lit).unwrap_or(1.0)).collect()
        };
        self.receivers.par_chunks(BAND_ROWS * self.width).flat_map_iter(band).collect()
    }

    /// How many of [`AROUND`] points are lit on the plane of a pixel's receiver, in a grid of half texels from one
    /// texel before it to one texel after it in u and in v: all that a bilinear lookup there can depend on. `None`
    /// where the truth is not valid or no view serves.
    #[must_use]
    pub fn lit_around(&self, frame: &ShadowFrame, origin: DVec3, pixel: usize, compare: Compare) -> Option<u32> {
        let receiver = self.receivers.get(pixel)?.as_ref()?;
        let tilt = self.grid(receiver, frame, origin)?.tilt(receiver);
        let half = AROUND_SIDE / 2;
        let points = (-half..=half).flat_map(|v| (-half..=half).map(move |u| DVec2::new(u.into(), v.into())));
        let offsets = points.map(|point| point / f64::from(half));
        Some(offsets.map(|offset| u32::from(self.is_lit(receiver, &tilt, compare, tilt.point(receiver, offset)))).sum())
    }

    /// The texels that serve a receiver.
    fn grid(&self, receiver: &Receiver, frame: &ShadowFrame, origin: DVec3) -> Option<Grid> {
        let view = serving(frame, &self.camera, origin, receiver.position - origin, receiver.normal)?;
        Some(Grid::of(frame, view, origin))
    }

    /// Filters the answers of the texels around a receiver.
    fn look_up(
        &self,
        receiver: &Receiver,
        grid: &Grid,
        filter: Pcf,
        compare: Compare,
        known: &mut HashMap<(usize, u32, I64Vec2), bool>,
    ) -> f64 {
        let tilt = grid.tilt(receiver);
        let (columns, rows) = (Taps::of(filter, tilt.at.x), Taps::of(filter, tilt.at.y));
        let mut sum = 0.0;
        for (y, row_weight) in rows.weights() {
            for (x, weight) in columns.weights() {
                let texel = I64Vec2::new(x, y);
                // What is not drawn is cleared to light; what has no weight need not be asked.
                let asked = weight * row_weight > 0.0;
                let drawn = texel.cmpge(grid.low).all() && texel.cmplt(grid.high).all();
                let mut ask = || {
                    let centre = texel.as_dvec2() + 0.5;
                    self.is_lit(receiver, &tilt, compare, tilt.point(receiver, centre - tilt.at))
                };
                let lit =
                    asked && (!drawn || *known.entry((grid.view, receiver.triangle, texel)).or_insert_with(&mut ask));
                sum += if lit { weight * row_weight } else { 0.0 };
            }
        }
        sum
    }

    /// Tells whether light reaches a point of a receiver's plane, or the surface that stands for it.
    fn is_lit(&self, receiver: &Receiver, tilt: &Tilt, compare: Compare, point: DVec3) -> bool {
        // Start above the plane.
        let direction = -self.travel;
        let start = PLANE_SLACK * self.bvh.radius() / receiver.normal.dot(direction);
        let towards_light = Ray { origin: point, direction, t_min: start, t_max: f64::INFINITY };
        let skip = Some(receiver.triangle);
        let below = (point - receiver.position).dot(self.travel).max(0.0);
        match compare {
            Compare::Plane => return !self.bvh.is_blocked(&towards_light, skip),
            Compare::Nearer => return !self.bvh.is_blocked(&Ray { t_min: start + below, ..towards_light }, skip),
            Compare::Surface => {}
        }
        let Some(above) = self.bvh.closest(&towards_light) else { return true };
        // Something is above. The plane is real here, or a surface below it is nearer: that is in its shadow.
        let onwards = Ray { origin: point, direction: self.travel, t_min: -start, t_max: above.t };
        if self.bvh.is_blocked(&onwards, None) {
            return false;
        }
        // What is above stands for the plane where it is as near to the receiver as texels read there are:
        // is it the first?
        let surface = point + direction * above.t;
        let near = surface.distance(receiver.position) <= tilt.reach;
        near && !self.bvh.is_blocked(&Ray { origin: surface, t_min: start, ..towards_light }, Some(above.triangle))
    }
}

impl Grid {
    /// The grid of a view.
    fn of(frame: &ShadowFrame, view: usize, origin: DVec3) -> Self {
        let uniforms = &frame.uniforms.views[view];
        let texels = |row: [f32; 4]| Vec4::from_array(row).as_dvec4() * f64::from(frame.map.side);
        let viewport = frame.views[view].viewport.to_array().map(i64::from);
        let low = I64Vec2::new(viewport[0], viewport[1]);
        let high = low + I64Vec2::new(viewport[2], viewport[3]);
        Self { view, u: texels(uniforms.u_from_render), v: texels(uniforms.v_from_render), origin, low, high }
    }

    fn tilt(&self, receiver: &Receiver) -> Tilt {
        let (u, v, n) = (self.u.truncate(), self.v.truncate(), receiver.normal);
        let at = (receiver.position - self.origin).extend(1.0);
        // Columns of the inverse of the matrix with rows u, v, n: a step of one texel along one of them,
        // none along the others.
        let (along_u, along_v) = (v.cross(n), n.cross(u));
        let (along_u, along_v) = (along_u / u.dot(along_u), along_v / v.dot(along_v));
        let reach = (along_u + along_v).length().max((along_u - along_v).length());
        Tilt { at: DVec2::new(self.u.dot(at), self.v.dot(at)), along_u, along_v, reach }
    }
}

impl Tilt {
    /// The point of the plane `offset` texels from the receiver.
    fn point(&self, receiver: &Receiver, offset: DVec2) -> DVec3 {
        receiver.position + self.along_u * offset.x + self.along_v * offset.y
    }
}

/// The texels that a filter reads along one axis, and their weights.
struct Taps {
    first: i64,
    /// Weights of the first and the last texel; those between have the mean's.
    ends: [f64; 2],
    /// Number of texels.
    count: i64,
    /// Weight of the texels between.
    between: f64,
}

impl Taps {
    /// A box as wide as the filter, at `at` texels from the map's edge,
    /// over texels as points that bilinear weights widen. A disc is the box of its variance; the light is a point, and so is
    /// the pixel.
    fn of(filter: Pcf, at: f64) -> Self {
        let width = match filter {
            Pcf::Point => return Self { first: at.floor() as i64, ends: [1.0, 0.0], count: 1, between: 0.0 },
            Pcf::Hardware2x2 | Pcf::Pcss | Pcf::Pixel => 1,
            Pcf::Box3x3 => 3,
            Pcf::Box5x5 | Pcf::Disc => 5,
            Pcf::Box7x7 => 7,
        };
        let base = (at - 0.5).floor();
        let part = at - 0.5 - base;
        let between = 1.0 / f64::from(width);
        let first = base as i64 - i64::from(width / 2);
        Self { first, ends: [(1.0 - part) * between, part * between], count: i64::from(width) + 1, between }
    }

    fn weights(&self) -> impl Iterator<Item = (i64, f64)> {
        (0..self.count).map(|index| {
            let weight = match index {
                0 => self.ends[0],
                last if last == self.count - 1 => self.ends[1],
                _ => self.between,
            };
            (self.first + index, weight)
        })
    }
}

/// A frame whose maps lie elsewhere on their grid: every texel moved by `texels` (less than 1 in size) along u and v.
///
/// The texels keep their size and what they cover to within one texel of the border, which the fit leaves for placing;
/// so a technique's score over such frames shows how much of it is the luck of one placement. Affine maps only.
#[must_use]
pub fn placed_elsewhere(frame: &ShadowFrame, texels: DVec2) -> ShadowFrame {
    let mut frame = frame.clone();
    let side = f64::from(frame.map.side);
    for (view, uniforms) in frame.views.iter_mut().zip(&mut frame.uniforms.views) {
        // Positions move against the texels; clip coordinates span two units over the viewport, with y upwards.
        let clip = texels * 2.0 / DVec2::new(f64::from(view.viewport.z), f64::from(view.viewport.w));
        let translation = &mut view.clip_from_render.w_axis;
        translation.x = (f64::from(translation.x) - clip.x) as f32;
        translation.y = (f64::from(translation.y) + clip.y) as f32;
        let moved = |row: &mut [f32; 4], by: f64| row[3] = (f64::from(row[3]) - by / side) as f32;
        moved(&mut uniforms.u_from_render, texels.x);
        moved(&mut uniforms.v_from_render, texels.y);
    }
    frame
}

#[cfg(test)]
mod tests;
