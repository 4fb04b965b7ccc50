//! From a triangle of the model to what the pixel loop needs: transform, clip, divide, snap, edge functions, planes.

use std::ops::Range;

use arrayvec::ArrayVec;
use glam::{DVec3, DVec4, Vec4};

use super::RasterPass;
use crate::lab::scene::{SOLID, SceneModel};

/// Steps per pixel that screen positions snap to: 8 fractional bits, what Direct3D 11 demands and Mesa's software
/// rasteriser uses. Fewer open cracks against a GPU's picture; more would need wider integers at 16384 pixels.
const SUBPIXEL: i64 = 256;

/// A triangle clipped by six planes has at most 3 + 6 corners.
const MAX_CORNERS: usize = 9;

/// The planes of the clip volume: a point is inside when `plane . clip >= 0`.
const CLIP_PLANES: [DVec4; 6] = [
    DVec4::new(1.0, 0.0, 0.0, 1.0),
    DVec4::new(-1.0, 0.0, 0.0, 1.0),
    DVec4::new(0.0, 1.0, 0.0, 1.0),
    DVec4::new(0.0, -1.0, 0.0, 1.0),
    DVec4::new(0.0, 0.0, 1.0, 0.0),
    DVec4::new(0.0, 0.0, -1.0, 1.0),
];

/// A corner before the division: clip coordinates, and (depth row, u, v) interpolated with them.
#[derive(Clone, Copy)]
struct Corner {
    clip: DVec4,
    varying: DVec3,
}

type Polygon = ArrayVec<Corner, MAX_CORNERS>;

/// The triangles of one chunk, ready to fill, in the order they were given.
#[derive(Default)]
pub(super) struct Setup {
    /// Rows each triangle may touch: apart, because every band reads all of them.
    pub(super) rows: Vec<Range<u32>>,
    pub(super) triangles: Vec<ScreenTriangle>,
    pub(super) varyings: Vec<Varyings>,
    pub(super) not_finite: usize,
}

/// A function that is linear on the screen, anchored at a corner so that no large numbers cancel.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    anchor: [f64; 2],
    value: f64,
    slope: [f64; 2],
}

/// An edge function at pixel centres: `a column + b row + c >= 0` inside.
#[derive(Clone, Copy)]
struct Edge {
    a: i64,
    b: i64,
    c: i64,
}

/// A triangle on the screen.
pub(super) struct ScreenTriangle {
    pub(super) id: u32,
    /// Index into [`Setup::varyings`] where depth alone does not do.
    pub(super) varyings: Option<u32>,
    columns: Range<i64>,
    edges: [Edge; 3],
    depth: Plane,
    /// Least and greatest depth of the corners: slivers would extrapolate beyond.
    depth_range: [f32; 2],
}

/// What cut-outs and a depth row need in each pixel: attributes over w, and 1/w to undo that.
pub(super) struct Varyings {
    pub(super) reciprocal_w: Plane,
    pub(super) depth: Option<Plane>,
    pub(super) u: Plane,
    pub(super) v: Plane,
    pub(super) cutout: Option<u32>,
}

impl Plane {
    /// The plane through three values at three screen positions; flat when the positions lie on one line.
    fn through(at: &[[f64; 2]; 3], values: [f64; 3]) -> Self {
        let [x1, y1] = [at[1][0] - at[0][0], at[1][1] - at[0][1]];
        let [x2, y2] = [at[2][0] - at[0][0], at[2][1] - at[0][1]];
        let determinant = x1 * y2 - x2 * y1;
        let (d1, d2) = (values[1] - values[0], values[2] - values[0]);
        let slope = if determinant == 0.0 {
            [0.0; 2]
        } else {
            [(d1 * y2 - d2 * y1) / determinant, (d2 * x1 - d1 * x2) / determinant]
        };
        Self { anchor: at[0], value: values[0], slope }
    }

    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        self.value + self.slope[0] * (x - self.anchor[0]) + self.slope[1] * (y - self.anchor[1])
    }
}

impl Edge {
    /// The edge from `start` to `end` (in 1/256 pixel, rows downwards) of a triangle that runs clockwise on the screen.
    fn new(start: [i64; 2], end: [i64; 2]) -> Self {
        let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
        // A centre on the edge counts only when the edge is a left one (running up) or a top one (level, running right)
        let top_left = dy < 0 || (dy == 0 && dx > 0);
        let at_corner = dy * start[0] - dx * start[1] - i64::from(!top_left);
        let centre = SUBPIXEL / 2;
        Self { a: -dy * SUBPIXEL, b: dx * SUBPIXEL, c: at_corner + centre * (dx - dy) }
    }

    /// Narrows `columns` to those inside on `row`.
    fn narrow(&self, row: i64, columns: &mut Range<i64>) {
        let rest = self.b * row + self.c;
        match self.a {
            0 if rest < 0 => columns.end = columns.start,
            0 => {}
            a if a > 0 => columns.start = columns.start.max(-rest.div_euclid(a)),
            a => columns.end = columns.end.min(rest.div_euclid(-a) + 1),
        }
    }
}

impl ScreenTriangle {
    /// First and one-past-last column whose centres the triangle covers on `row`.
    pub(super) fn columns_of_row(&self, row: usize) -> (usize, usize) {
        let mut columns = self.columns.clone();
        for edge in &self.edges {
            edge.narrow(row as i64, &mut columns);
        }
        (columns.start as usize, columns.end.max(columns.start) as usize)
    }

    /// Depth (clip z/w) at a screen position, pixels.
    pub(super) fn depth_at(&self, x: f64, y: f64) -> f32 {
        (self.depth.at(x, y) as f32).clamp(self.depth_range[0], self.depth_range[1])
    }
}

impl Setup {
    pub(super) fn new(model: &SceneModel, chunk: Range<usize>, pass: &RasterPass, width: u32, height: u32) -> Self {
        let mut setup = Self::default();
        for id in chunk {
            // Transform as a vertex shader would
            let corners = model.triangles[id].map(|vertex| transform(model, vertex as usize, pass));
            if !corners.iter().all(|corner| corner.clip.is_finite() && corner.varying.is_finite()) {
                setup.not_finite += 1;
                continue;
            }

            // Clip to the view volume, then fan what is left
            let Some(polygon) = clip(corners) else { continue };
            let cutout = model.triangle_cutout.get(id).copied().filter(|&cutout| cutout != SOLID);
            for i in 1..polygon.len().saturating_sub(1) {
                setup.push(id, [polygon[0], polygon[i], polygon[i + 1]], cutout, pass, [width, height]);
            }
        }
        setup
    }

    fn push(&mut self, id: usize, corners: [Corner; 3], cutout: Option<u32>, pass: &RasterPass, size: [u32; 2]) {
        // Divide, map to the screen and snap
        let screen = corners.map(|corner| project(&corner, size));
        let mut snapped = screen.map(|corner| [snap(corner[0]), snap(corner[1])]);

        // Drop what has no area; turn what runs anticlockwise on the screen
        match area(&snapped) {
            0 => return,
            area if area < 0 => snapped.swap(1, 2),
            _ => {}
        }

        // Bound the pixels whose centres may be inside
        let columns = covered(snapped.map(|corner| corner[0]), size[0]);
        let rows = covered(snapped.map(|corner| corner[1]), size[1]);
        if columns.is_empty() || rows.is_empty() {
            return;
        }

        // Planes go through the positions before snapping: these lie on the surface
        let at = screen.map(|corner| [f64::from(corner[0]), f64::from(corner[1])]);
        let depths = screen.map(|corner| corner[2]);
        let varyings = (cutout.is_some() || pass.depth_from_render.is_some()).then(|| {
            self.varyings.push(varyings(&corners, &at, cutout, pass.depth_from_render.is_some()));
            self.varyings.len() as u32 - 1
        });
        self.rows.push(rows.start as u32..rows.end as u32);
        self.triangles.push(ScreenTriangle {
            id: id as u32,
            varyings,
            columns,
            edges: [0, 1, 2].map(|i| Edge::new(snapped[i], snapped[(i + 1) % 3])),
            depth: Plane::through(&at, depths.map(f64::from)),
            depth_range: [depths[0].min(depths[1]).min(depths[2]), depths[0].max(depths[1]).max(depths[2])],
        });
    }
}

/// Narrows a vertex to `f32` as a vertex buffer would hold it and transforms it in `f32`.
fn transform(model: &SceneModel, vertex: usize, pass: &RasterPass) -> Corner {
    let render: Vec4 = (model.positions[vertex] - pass.origin).as_vec3().extend(1.0);
    let row = pass.depth_from_render.map_or(0.0, |row| row.dot(render));
    let uv = model.uvs.get(vertex).copied().unwrap_or_default();
    Corner { clip: (pass.clip_from_render * render).as_dvec4(), varying: DVec3::new(f64::from(row), uv.x, uv.y) }
}

/// Cuts a triangle by the clip volume (Sutherland-Hodgman); `None` when nothing is left.
fn clip(corners: [Corner; 3]) -> Option<Polygon> {
    let mut polygon: Polygon = corners.into_iter().collect();
    for plane in CLIP_PLANES {
        // Skip planes that do not cut
        let distance = |corner: &Corner| plane.dot(corner.clip);
        if polygon.iter().all(|corner| distance(corner) >= 0.0) {
            continue;
        }

        // Keep the inside corners; cut edges from their inside end, so that both triangles of an edge cut it alike
        let mut kept = Polygon::new();
        for (i, corner) in polygon.iter().enumerate() {
            let next = &polygon[(i + 1) % polygon.len()];
            if distance(corner) >= 0.0 {
                kept.push(*corner);
            }
            if (distance(corner) >= 0.0) != (distance(next) >= 0.0) {
                let (inside, outside) = if distance(corner) >= 0.0 { (corner, next) } else { (next, corner) };
                kept.push(cut(inside, outside, distance(inside), distance(outside)));
            }
        }
        polygon = kept;
        if polygon.len() < 3 {
            return None;
        }
    }

    // The eye itself has w = 0 and no direction; less than the least normal number has no finite reciprocal
    polygon.iter().all(|corner| corner.clip.w as f32 >= f32::MIN_POSITIVE).then_some(polygon)
}

fn cut(inside: &Corner, outside: &Corner, inside_distance: f64, outside_distance: f64) -> Corner {
    let t = inside_distance / (inside_distance - outside_distance);
    Corner {
        clip: inside.clip + (outside.clip - inside.clip) * t,
        varying: inside.varying + (outside.varying - inside.varying) * t,
    }
}

/// Screen x, y in pixels (row 0 on top) and depth, in `f32` like a GPU's viewport transform.
fn project(corner: &Corner, size: [u32; 2]) -> [f32; 3] {
    let clip = corner.clip.as_vec4();
    let reciprocal_w = 1.0 / clip.w;
    let half = size.map(|side| side as f32 * 0.5);
    [
        clip.x * reciprocal_w * half[0] + half[0],
        half[1] - clip.y * reciprocal_w * half[1],
        (clip.z * reciprocal_w).clamp(0.0, 1.0),
    ]
}

fn snap(pixels: f32) -> i64 {
    (pixels * SUBPIXEL as f32).round() as i64
}

/// Twice the signed area in 1/256 pixel squared; positive when clockwise on a screen with rows downwards.
fn area(corners: &[[i64; 2]; 3]) -> i64 {
    let [a, b, c] = corners;
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Pixels of one axis whose centres lie between the least and the greatest coordinate (1/256 pixel).
fn covered(coordinates: [i64; 3], side: u32) -> Range<i64> {
    let [a, b, c] = coordinates;
    let first = (a.min(b).min(c) + SUBPIXEL / 2 - 1).div_euclid(SUBPIXEL);
    let last = (a.max(b).max(c) - SUBPIXEL / 2).div_euclid(SUBPIXEL);
    first.max(0)..(last + 1).min(i64::from(side))
}

fn varyings(corners: &[Corner; 3], at: &[[f64; 2]; 3], cutout: Option<u32>, has_row: bool) -> Varyings {
    let over_w =
        |pick: fn(&Corner) -> f64| Plane::through(at, [0, 1, 2].map(|i| pick(&corners[i]) / corners[i].clip.w));
    Varyings {
        reciprocal_w: over_w(|_| 1.0),
        depth: has_row.then(|| over_w(|corner| corner.varying.x)),
        u: over_w(|corner| corner.varying.y),
        v: over_w(|corner| corner.varying.z),
        cutout,
    }
}
