//! The footprint of a texel in the picture: how far aliasing goes at a point, and where it comes from.
//!
//! At a point of a receiver, J = ∂texel/∂pixel is the Jacobian of the map with respect to the screen, along the plane
//! of the receiver. Its smallest singular value is the number of texels over a pixel in the direction in which there
//! are fewest; one over it, Lloyd's m, is the longest extent of a texel in the picture. It has two factors:
//! - *perspective*: m of a receiver that faces both the light and the camera,
//!   what warps and splits can do something about;
//! - *projection*: by how much the receiver's own slant makes that larger (or smaller),
//!   which no map of a view can change.
//!
//! [`footprint_at`] is for measuring and debug views, in f64; [`encoding::footprint`](crate::encoding::footprint) is
//! its twin for shaders. [`Spread`] sums up many points; [`perspective_spread`] predicts one before anything is drawn.
//!
//! # References
//! - Lloyd, Govindaraju, Quammen, Molnar & Manocha, *Logarithmic perspective shadow maps*, 2008:
//!   error m = texel over pixel.
//! - `MATH.md` section 8.

use glam::{DVec2, DVec3, Vec4};

use crate::camera::Camera;
use crate::frame::{Footprint, ShadowView, ViewUniforms};

/// The footprint of a map's texels at one point of a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointFootprint {
    /// Texels over a pixel in the direction in which there are fewest, `σ_min(J)`: 1 or more means no aliasing, 0 that
    /// the light only grazes the surface.
    pub texels_per_pixel: f64,
    /// Longest extent of a texel in the picture, pixels: 1/`σ_min(J)`, Lloyd's m. Infinite where the light only grazes
    /// the surface.
    pub pixels_per_texel: f64,
    /// Its perspective part, pixels: what it is for a receiver that faces both light and camera. Finite,
    /// greater than 0.
    pub perspective: f64,
    /// Its projection part: `pixels_per_texel` over `perspective`, 0 or more. 1 for a receiver that faces half-way
    /// between light and camera, more for one that the light grazes.
    pub projection: f64,
    /// Pixels that a texel covers, 1/|det J|: 0 where the surface is seen from its edge, infinite where the light only
    /// grazes it.
    pub area: f64,
}

/// The footprint of a map at a point of a receiver with a normal, both in render space;
/// `side` is that of the map, texels.
///
/// `None` where there is none: outside of the part of the map that is drawn, behind the map's centre of projection or
/// the eye, and for inputs that are not finite or a normal without direction. Whether the light is in front of the
/// surface or behind it makes no difference. O(1), no allocation; kind of promise: exact for the plane, up to rounding.
#[must_use]
pub fn footprint_at(
    view: &ViewUniforms,
    side: u32,
    camera: &Camera,
    origin: DVec3,
    position: DVec3,
    normal: DVec3,
) -> Option<PointFootprint> {
    let normal = normal.try_normalize()?;
    // How the map changes over the world, and what a pixel measures where it is parallel to the picture.
    let map = Gradients::at(view, side, position)?;
    let lens = Lens::at(camera, origin, position)?;
    let perspective = map.perspective(&lens)?;
    // Steps from a pixel to the next on the receiver's plane, times the cosine to the line of sight:
    // finite from its edge, too.
    let facing = normal.dot(lens.sight);
    let on_plane = |axis: DVec3| axis * facing - lens.sight * normal.dot(axis);
    let [x, y] = [on_plane(lens.axes[0]) * lens.pixel.x, on_plane(lens.axes[1]) * lens.pixel.y];
    // The largest singular value of J and its determinant, each times that cosine.
    let [along_x, along_y] = [x, y].map(|step| DVec2::new(map.u.dot(step), map.v.dot(step)));
    let longest = longest(along_x.length_squared(), along_x.dot(along_y), along_y.length_squared());
    let sight_by_picture = lens.axes[0].cross(lens.axes[1]).dot(lens.sight).abs();
    let determinant = map.u.cross(map.v).dot(normal).abs() * sight_by_picture * lens.pixel.element_product();
    let texels_per_pixel = if longest > 0.0 { determinant / longest } else { 0.0 };
    let pixels_per_texel = 1.0 / texels_per_pixel;
    let area = if determinant > 0.0 { facing.abs() / determinant } else { f64::INFINITY };
    let found = PointFootprint {
        texels_per_pixel,
        pixels_per_texel,
        perspective,
        projection: pixels_per_texel / perspective,
        area,
    };
    (texels_per_pixel.is_finite() && !found.projection.is_nan() && !area.is_nan()).then_some(found)
}

/// The perspective part alone, pixels per texel: for points whose normal is not known, as bounds and bodies have them.
///
/// `None` as in [`footprint_at`].
#[must_use]
pub fn perspective_at(view: &ViewUniforms, side: u32, camera: &Camera, origin: DVec3, position: DVec3) -> Option<f64> {
    Gradients::at(view, side, position)?.perspective(&Lens::at(camera, origin, position)?)
}

/// How a map's texel coordinates change over the world at a point: texels per world unit.
struct Gradients {
    u: DVec3,
    v: DVec3,
}

impl Gradients {
    /// Where the map is drawn.
    fn at(view: &ViewUniforms, side: u32, position: DVec3) -> Option<Self> {
        let [u, v, w] =
            [view.u_from_render, view.v_from_render, view.w_from_render].map(|row| Vec4::from(row).as_dvec4());
        let at = position.extend(1.0);
        let from_w = 1.0 / w.dot(at);
        let uv = DVec2::new(u.dot(at), v.dot(at)) * from_w;
        let [low, high] = [0, 2].map(|first| DVec2::new(view.rect[first].into(), view.rect[first + 1].into()));
        let inside = from_w > 0.0 && uv.cmpge(low).all() && uv.cmple(high).all();
        let texels = f64::from(side) * from_w;
        inside.then(|| Self {
            u: (u.truncate() - w.truncate() * uv.x) * texels,
            v: (v.truncate() - w.truncate() * uv.y) * texels,
        })
    }

    /// Longest extent of a texel across the light, over a pixel of the finer axis.
    fn perspective(&self, lens: &Lens) -> Option<f64> {
        let longest = longest(self.u.length_squared(), self.u.dot(self.v), self.v.length_squared());
        // Across the light, the two singular values multiply to the area of the gradients.
        let found = longest / (self.u.cross(self.v).length() * lens.pixel.min_element());
        (found > 0.0 && found.is_finite()).then_some(found)
    }
}

/// How the camera sees a point.
struct Lens {
    /// Directions of the picture's axes in render space: right and up, unit length.
    axes: [DVec3; 2],
    /// Along the line of sight, one unit of eye depth long.
    sight: DVec3,
    /// Width and height of a pixel at the point's eye depth, world units.
    pixel: DVec2,
}

impl Lens {
    /// In front of the eye.
    fn at(camera: &Camera, origin: DVec3, position: DVec3) -> Option<Self> {
        let spreads = camera.projection.spreads();
        let depth = camera.eye_depth(position, origin);
        let from_eye = position - (camera.eye() - origin);
        let spread = if spreads { depth } else { 1.0 };
        let lens = Self {
            axes: [camera.world_from_view.x_axis.truncate(), camera.world_from_view.y_axis.truncate()],
            sight: if spreads { from_eye / depth } else { camera.forward() },
            pixel: camera.projection.size_at(1.0) / camera.viewport.as_dvec2() * spread,
        };
        (spread > 0.0 && lens.sight.is_finite() && lens.pixel.is_finite()).then_some(lens)
    }
}

/// The largest singular value of two vectors, from their products with themselves and each other.
fn longest(first: f64, both: f64, second: f64) -> f64 {
    (0.5 * (first + second + (first - second).hypot(2.0 * both))).sqrt()
}

/// How figures are spread over many points: extremes and percentiles, each a value that occurs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The least.
    pub min: f64,
    /// One in 20 is at most this.
    pub low: f64,
    /// One in two is at most this.
    pub median: f64,
    /// 19 in 20 are at most this.
    pub high: f64,
    /// The greatest.
    pub max: f64,
}

impl Spread {
    /// Of `values`, which are put in order; `None` of none. NaN counts as greater than infinity. O(n log n).
    #[must_use]
    pub fn of(values: &mut [f64]) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let [min, low, median, high, max] =
            [0.0, 0.05, 0.5, 0.95, 1.0].map(|share| values[(share * last as f64).round() as usize]);
        Some(Self { min, low, median, high, max })
    }
}

/// Columns, rows and steps of depth at which [`perspective_spread`] looks. Half of it moves the percentiles by about a
/// twentieth, twice of it costs eight times the time.
const BODY_GRID: [u32; 3] = [16, 12, 24];

/// How the perspective part, pixels per texel, is spread over what a view serves: its part of the view volume, where
/// every place in the picture and every octave of eye depth counts the same. `view` and `uniforms` are of one frame,
/// `side` is that of its map.
///
/// Kind of promise: typical. What is in view may crowd anywhere in it; `ShadowView::texel` has the extremes over the
/// body. Cold path: allocates.
#[must_use]
pub fn perspective_spread(
    view: &ShadowView,
    uniforms: &ViewUniforms,
    side: u32,
    camera: &Camera,
    origin: DVec3,
) -> Option<Spread> {
    let [near, far] = view.domain.map(f64::from);
    let half = 0.5 * camera.projection.size_at(1.0);
    let share = |index: u32, axis: usize| (f64::from(index) + 0.5) / f64::from(BODY_GRID[axis]);
    // Depths of an orthographic camera may be negative: there is no octave of those.
    let octaves = near > 0.0 && far > near;
    let mut values = Vec::with_capacity(BODY_GRID.iter().product::<u32>() as usize);
    for depth in (0..BODY_GRID[2]).map(|step| share(step, 2)) {
        let depth = if octaves { near * (far / near).powf(depth) } else { near + (far - near) * depth };
        for (column, row) in (0..BODY_GRID[0]).flat_map(|column| (0..BODY_GRID[1]).map(move |row| (column, row))) {
            let aside = DVec2::new(share(column, 0), share(row, 1)) * 2.0 - 1.0;
            let (start, along) = camera.ray(camera.projection.middle() + half * aside, origin);
            values.extend(perspective_at(uniforms, side, camera, origin, start + along * depth));
        }
    }
    Spread::of(&mut values)
}

/// What a body's vertices say of a map's texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extremes {
    /// Pixels per texel: its longest side over a pixel at the eye depth.
    pub(crate) pixels: Footprint,
    /// Shortest and longest side of a texel, world units.
    pub(crate) world: [f32; 2],
    /// Nearest and farthest eye depth.
    pub(crate) domain: [f32; 2],
}

/// The extremes over the vertices of a body; `squares` gives the squares of a texel's sides at a vertex,
/// world units across the light.
///
/// Exact for surfaces that face both the light and the camera. O(vertices).
pub(crate) fn extremes(
    camera: &Camera,
    vertices: &[DVec3],
    origin: DVec3,
    squares: impl Fn(DVec3) -> [f64; 2],
) -> Extremes {
    let (near, far) = camera.projection.depth_range();
    let pixels_per_unit = camera.pixels_per_unit();
    let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for vertex in vertices {
        let depth = camera.eye_depth(*vertex, origin).clamp(near, far);
        let [one, other] = squares(*vertex);
        let (short, long) = (one.min(other), one.max(other));
        let per_unit = pixels_per_unit / if camera.projection.spreads() { depth } else { 1.0 };
        let pixels = long * per_unit * per_unit;
        (nearest, farthest) = (nearest.min(depth), farthest.max(depth));
        (shortest, longest) = (shortest.min(short), longest.max(long));
        (least, most) = (least.min(pixels), most.max(pixels));
    }
    Extremes {
        pixels: Footprint { min: narrowed(least.sqrt()), max: narrowed(most.sqrt()), error: 0.0 },
        world: [narrowed(shortest.sqrt()), narrowed(longest.sqrt())],
        domain: [nearest as f32, farthest as f32],
    }
}

/// To f32. A lens that sees nothing wide makes texels that fill any picture: the largest number stands for it.
fn narrowed(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}
