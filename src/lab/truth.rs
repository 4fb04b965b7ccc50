//! What is really lit: ray-traced visibility of the light, independent of every shadow map.
//!
//! Two truths per pixel. *Centre*: one ray through the pixel's centre; an unfiltered shadow map of endless resolution
//! would reproduce it exactly. *Area*: the mean over the pixel, what a perfect filter would show.
//!
//! The rules, each of which the published floors of nine cases depend on (`tests/truth.rs`):
//! - A sample is *defined* when its view ray meets geometry between the near and the far plane and the light can shine
//!   on the side that is seen: N·L > 0 with the geometric normal turned towards the eye, whatever the winding says. For
//!   a spot or point light the point must also lie inside cone and range.
//! - A pixel is *valid* when its centre sample is defined.
//! - Samples of the area that are not defined do not count: the area truth is the mean over the others.
//! - 16 samples, jittered in a 4×4 grid; where they, the centre and the pixel's corners disagree, 64 more in an 8×8
//!   grid. Centre and corners only ask for more, they are not part of the mean.
//! - A light of some size ([`Truth::soft`]) lights by the share of its disc that is seen, of what of it is above the
//!   surface's plane: 64 rays from the centre, 16 from each sample of the area. What is defined its middle says.
//!
//! The shadow distance of a case is a limit of techniques, not of light: truth ignores it.

mod cache;
mod disc;

use glam::DVec3;
use rayon::prelude::*;

use super::bvh::{Bvh, Hit, Ray};
use super::case::{Case, CaseLight};
use super::scene::SceneModel;
use super::shapes::Random;
use disc::{AREA_RAYS, CENTRE_RAYS, LightDisc};

pub use cache::{CACHE_VARIABLE, CacheUse, TruthCache};

/// Side of the grid of samples that every valid pixel gets: 16 in all. Fewer miss thin shadows, more cost time.
const COARSE_GRID: u32 = 4;

/// Side of the grid of further samples where the first disagree: 64 in all. The error of a pixel that a straight edge
/// cuts is then about 1/100; 4 would leave three times as much, 16 would cost four times the time.
const FINE_GRID: u32 = 8;

/// Where a shadow ray starts, as a part of the scene's radius. A hit point in f64 is off by some 10⁻¹⁵ of it and
/// coincident surfaces must not shadow each other; a gap between caster and receiver below this is not seen.
const SHADOW_START: f64 = 1e-9;

/// Sine of the greatest angle (15°) by which two neighbouring points of one surface may lie out of each other's plane:
/// less cuts curved surfaces into pieces, more ties surfaces together that lie behind each other.
const SURFACE_SINE: f64 = 0.258_819_045_102_520_74;

/// Marks a pixel without geometry in [`Truth::triangle`].
pub const NO_TRIANGLE: u32 = u32::MAX;

/// What is lit in one picture. Every list has `width * height` entries, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
    /// Whether shadows can be judged here: geometry at the pixel's centre, turned towards the light.
    pub valid: Vec<bool>,
    /// Light at the pixel's centre, 0 or 1, or between them where the light has a size. Without meaning where not
    /// valid: 1 without geometry, 0 turned away.
    pub centre: Vec<f32>,
    /// Mean light over the pixel, 0 to 1; same as `centre` where not valid.
    pub area: Vec<f32>,
    /// Eye depth (distance along the view axis) at the pixel's centre, world units; infinite without geometry.
    pub depth: Vec<f32>,
    /// Geometric normal at the pixel's centre in world space, turned towards the eye; zero without geometry.
    pub normal: Vec<[f32; 3]>,
    /// Triangle at the pixel's centre, an index into [`SceneModel::triangles`]; [`NO_TRIANGLE`] without geometry.
    pub triangle: Vec<u32>,
    /// Whether the pixel lies on one surface with its right neighbour ([`JOINS_RIGHT`]) and its lower neighbour
    /// ([`JOINS_BELOW`]): both are valid and each lies in the other's tangent plane to within 15°.
    pub joins: Vec<u8>,
}

/// Bit of [`Truth::joins`]: one surface with the right neighbour.
pub const JOINS_RIGHT: u8 = 1;

/// Bit of [`Truth::joins`]: one surface with the neighbour below.
pub const JOINS_BELOW: u8 = 2;

impl Truth {
    /// Traces a case that has passed [`Case::check`]; `on_row` is called once per finished row, from any thread.
    ///
    /// Equal inputs give equal bits, however many threads there are. About 1.5 million rays per second and core.
    #[must_use]
    pub fn trace(case: &Case, scene: &SceneModel, on_row: &(dyn Fn() + Sync)) -> Self {
        Self::soft(case, scene, 0.0, on_row)
    }

    /// The same for a light that receivers see as a disc of this angular diameter, radians, 0 to 0.5: with penumbras.
    /// At 0 it is [`trace`](Self::trace), to the bit. Ten times as many rays, in penumbras thirty.
    #[must_use]
    pub fn soft(case: &Case, scene: &SceneModel, angle: f64, on_row: &(dyn Fn() + Sync)) -> Self {
        let tracer = Tracer::new(case, Bvh::new(scene), LightDisc::new(angle));
        let [width, height] = case.viewport;
        // Trace the rows in parallel and lay them out in order.
        let pixels: Vec<Pixel> = (0..height)
            .into_par_iter()
            .flat_map_iter(|y| {
                let row: Vec<Pixel> = (0..width).map(|x| tracer.pixel(x, y)).collect();
                on_row();
                row
            })
            .collect();
        Self {
            width,
            height,
            valid: pixels.iter().map(|pixel| pixel.valid).collect(),
            centre: pixels.iter().map(|pixel| pixel.centre).collect(),
            area: pixels.iter().map(|pixel| pixel.area).collect(),
            depth: pixels.iter().map(|pixel| pixel.surface.map_or(f32::INFINITY, |s| s.depth as f32)).collect(),
            normal: pixels
                .iter()
                .map(|pixel| pixel.surface.map_or([0.0; 3], |s| s.normal.as_vec3().to_array()))
                .collect(),
            triangle: pixels.iter().map(|pixel| pixel.surface.map_or(NO_TRIANGLE, |s| s.triangle)).collect(),
            joins: join_neighbours(&pixels, width as usize),
        }
    }

    /// Number of valid pixels.
    #[must_use]
    pub fn valid_count(&self) -> usize {
        self.valid.iter().filter(|&&valid| valid).count()
    }
}

/// The truth of one pixel.
struct Pixel {
    valid: bool,
    centre: f32,
    area: f32,
    surface: Option<Surface>,
}

/// What a view ray meets.
#[derive(Clone, Copy)]
struct Surface {
    position: DVec3,
    /// Towards the eye, unit length (zero for a triangle too small to have one).
    normal: DVec3,
    depth: f64,
    triangle: u32,
}

/// What one sample of the picture shows.
enum Sample {
    /// No geometry.
    Nothing,
    /// Geometry that the light cannot reach, shadows or not.
    Unlit(Surface),
    /// Geometry that is lit or in shadow, or by a share.
    Defined { surface: Surface, lit: f32 },
}

/// Traces samples of one case.
struct Tracer<'c> {
    case: &'c Case,
    bvh: Bvh<'c>,
    light: LightDisc,
    eye: DVec3,
    /// View ray at the upper left corner of the picture, and its change across the picture; eye depth 1.
    corner: DVec3,
    across: DVec3,
    down: DVec3,
}

impl<'c> Tracer<'c> {
    fn new(case: &'c Case, bvh: Bvh<'c>, light: LightDisc) -> Self {
        let world_from_view = case.world_from_view();
        let [left, right, lower, upper] = case.tangents();
        let ray = |x: f64, y: f64| world_from_view.transform_vector3(DVec3::new(x, y, -1.0));
        let corner = ray(left, upper);
        let [width, height] = case.viewport.map(f64::from);
        let across = (ray(right, upper) - corner) / width;
        let down = (ray(left, lower) - corner) / height;
        Self { case, bvh, light, eye: case.camera.eye, corner, across, down }
    }

    /// Finds the truth of a pixel.
    fn pixel(&self, x: u32, y: u32) -> Pixel {
        let [left, top] = [x, y].map(f64::from);
        // Look through the centre; without a defined sample there the pixel is not valid.
        let (surface, centre) = match self.sample(left + 0.5, top + 0.5, CENTRE_RAYS) {
            Sample::Nothing => return Pixel { valid: false, centre: 1.0, area: 1.0, surface: None },
            Sample::Unlit(surface) => {
                return Pixel { valid: false, centre: 0.0, area: 0.0, surface: Some(surface) };
            }
            Sample::Defined { surface, lit } => (surface, lit),
        };
        // Average the area; look closer where the samples disagree.
        let mut tally = Tally::default();
        self.add_grid(&mut tally, COARSE_GRID, left, top);
        if !tally.agrees_with(centre) || self.corners_differ(centre, left, top) {
            self.add_grid(&mut tally, FINE_GRID, left, top);
        }
        Pixel { valid: true, centre, area: tally.mean().unwrap_or(centre), surface: Some(surface) }
    }

    /// Tells whether a corner of the pixel is defined and not as the centre: an edge may cut off less than one sample's
    /// share. The corners themselves do not count towards the mean; they would weigh its rim double.
    fn corners_differ(&self, centre: f32, left: f64, top: f64) -> bool {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        corners.iter().any(|(x, y)| match self.sample(left + x, top + y, AREA_RAYS) {
            Sample::Defined { lit, .. } => lit != centre,
            Sample::Nothing | Sample::Unlit(_) => false,
        })
    }

    /// Adds the defined samples of a jittered grid over the pixel.
    fn add_grid(&self, tally: &mut Tally, side: u32, left: f64, top: f64) {
        for cell in 0..side * side {
            let [column, row] = [cell % side, cell / side].map(f64::from);
            let [jitter_x, jitter_y] = jitter(left as u32, top as u32, side, cell);
            let x = left + (column + jitter_x) / f64::from(side);
            let y = top + (row + jitter_y) / f64::from(side);
            if let Sample::Defined { lit, .. } = self.sample(x, y, AREA_RAYS) {
                tally.lit += lit;
                tally.count += 1.0;
            }
        }
    }

    /// Looks through a point of the picture, in pixels from its upper left corner, and from there at the light.
    fn sample(&self, x: f64, y: f64, light_rays: u32) -> Sample {
        // The ray's third view coordinate is -1, so its parameter is eye depth.
        let direction = self.corner + self.across * x + self.down * y;
        let (t_min, t_max) = (self.case.camera.near, self.case.camera.far);
        let Some(hit) = self.bvh.closest(&Ray { origin: self.eye, direction, t_min, t_max }) else {
            return Sample::Nothing;
        };
        let surface = self.surface(&hit, direction);
        let Some(ray) = self.shadow_ray(&surface) else { return Sample::Unlit(surface) };
        let is_lit = |ray: &Ray| !self.bvh.is_blocked(ray, Some(hit.triangle));
        Sample::Defined { surface, lit: self.light.mean(&ray, surface.normal, light_rays, [x, y], is_lit) }
    }

    fn surface(&self, hit: &Hit, direction: DVec3) -> Surface {
        let [a, b, c] = self.bvh.scene().corners(hit.triangle as usize);
        let front = (b - a).cross(c - a).normalize_or_zero();
        let normal = if front.dot(direction) > 0.0 { -front } else { front };
        Surface { position: self.eye + direction * hit.t, normal, depth: hit.t, triangle: hit.triangle }
    }

    /// Returns the ray to the middle of the light; `None` where no light can come from, in shadow or not.
    fn shadow_ray(&self, surface: &Surface) -> Option<Ray> {
        let origin = surface.position;
        let start = SHADOW_START * self.bvh.radius();
        let ray = match self.case.light {
            CaseLight::Directional { travel } => Ray { origin, direction: -travel, t_min: start, t_max: f64::INFINITY },
            CaseLight::Spot { position, range, .. } | CaseLight::Point { position, range } => {
                let direction = position - origin;
                let distance = direction.length();
                if !(distance > start && distance <= range) {
                    return None;
                }
                Ray { origin, direction, t_min: start / distance, t_max: 1.0 }
            }
        };
        if let CaseLight::Spot { travel, half_angle_deg, .. } = self.case.light {
            let cosine = -ray.direction.dot(travel) / ray.direction.length();
            if cosine < half_angle_deg.to_radians().cos() {
                return None;
            }
        }
        (surface.normal.dot(ray.direction) > 0.0).then_some(ray)
    }
}

/// Counts defined samples. Numbers are whole and small where the light has no size: exact.
#[derive(Default)]
struct Tally {
    lit: f32,
    count: f32,
}

impl Tally {
    /// Tells whether the samples are as lit as the centre is.
    fn agrees_with(&self, lit: f32) -> bool {
        self.lit == lit * self.count
    }

    fn mean(&self) -> Option<f32> {
        (self.count > 0.0).then(|| self.lit / self.count)
    }
}

/// Two numbers in 0..1 for a cell of a pixel's grid, the same on every run: their key is made of pixel and cell.
fn jitter(x: u32, y: u32, side: u32, cell: u32) -> [f64; 2] {
    let seed = (u64::from(x) << 40) ^ (u64::from(y) << 16) ^ u64::from(side * side + cell);
    let bits = Random::new(seed).bits();
    let unit = |half: u32| f64::from(half) / (f64::from(u32::MAX) + 1.0);
    [unit((bits >> 32) as u32), unit(bits as u32)]
}

/// Marks which neighbours lie on one surface.
fn join_neighbours(pixels: &[Pixel], width: usize) -> Vec<u8> {
    let join = |index: usize| {
        let right = !(index + 1).is_multiple_of(width) && lie_on_one_surface(&pixels[index], &pixels[index + 1]);
        let below = pixels.get(index + width).is_some_and(|below| lie_on_one_surface(&pixels[index], below));
        (u8::from(right) * JOINS_RIGHT) | (u8::from(below) * JOINS_BELOW)
    };
    (0..pixels.len()).map(join).collect()
}

/// Tells whether two valid pixels show one surface: one triangle, or each near the other's tangent plane.
fn lie_on_one_surface(a: &Pixel, b: &Pixel) -> bool {
    let (true, Some(a), Some(b)) = (a.valid && b.valid, a.surface, b.surface) else { return false };
    let step = b.position - a.position;
    let limit = SURFACE_SINE * step.length();
    a.triangle == b.triangle || (a.normal.dot(step).abs() <= limit && b.normal.dot(step).abs() <= limit)
}
