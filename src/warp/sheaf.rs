//! A sheaf of rays through the picture, and where each of them is inside a body.
//!
//! A wall of the body, `n · x + w ≥ 0`, along a ray `x = start + direction ζ`, over one parameter t for which its
//! coefficient is the same for all rays, so that a division a wall serves the whole sheaf:
//!
//! ```text
//! (1)  perspective:    (n · eye + w) t + n · direction ≥ 0,       t = 1/ζ
//! (2)  orthographic:   (n · direction) t + n · start + w ≥ 0,     t = ζ
//! ```
//!
//! The second summand is affine over the picture.
//!
//! # References
//! - Cyrus & Beck, *Generalized two- and three-dimensional clipping*, 1978: a line against one half-space after the
//!   other.

use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::focus::FocusBody;
use crate::scene::DepthRange;

/// Rays across and down the part of the picture that the body covers. Twice as many in each direction move the chosen
/// strength by a hundredth and cost a microsecond; half as many make it jump where a ray leaves the body.
const RAYS: [usize; 2] = [6, 4];

/// Rays of the sheaf.
const ALL: usize = RAYS[0] * RAYS[1];

/// Column and row of each.
const COLUMN: [f64; ALL] = places(1, RAYS[0]);
const ROW: [f64; ALL] = places(RAYS[0], RAYS[1]);

const fn places(repeat: usize, count: usize) -> [f64; ALL] {
    let mut places = [0.0; ALL];
    let mut ray = 0;
    while ray < ALL {
        places[ray] = (ray / repeat % count) as f64;
        ray += 1;
    }
    places
}

/// Least coefficient of t in a wall: the eye in a wall itself is on its inner side.
const SMALLEST: f64 = 1e-300;

/// The rays over the part of the picture that a body covers.
pub(crate) struct Sheaf {
    /// The first ray: start, relative to the eye, and direction.
    first: [DVec3; 2],
    /// What the next ray in a row, and in a column, has more of both.
    steps: [[DVec3; 2]; 2],
    /// Least and greatest t of each.
    low: [f64; ALL],
    high: [f64; ALL],
    /// Whether t is 1/ζ.
    inverse: bool,
}

impl Sheaf {
    /// Through a body with at least one vertex, in view of `camera`.
    pub(crate) fn through(body: &FocusBody, camera: &Camera, origin: DVec3) -> Self {
        // The part of the picture that it covers, in cells.
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for vertex in &body.vertices {
            let at = camera.picture_position(*vertex, origin);
            low = low.min(at);
            high = high.max(at);
        }
        let cell = (high - low) / DVec2::new(RAYS[0] as f64, RAYS[1] as f64);
        let [first, right, down] =
            [low + 0.5 * cell, low + 0.5 * cell + cell * DVec2::X, low + 0.5 * cell + cell * DVec2::Y]
                .map(|at| <[DVec3; 2]>::from(camera.ray(at, camera.eye())));
        let steps = [right, down].map(|next| [next[0] - first[0], next[1] - first[1]]);
        // Between the depths of the body, and inside its walls.
        let inverse = camera.projection.spreads();
        // Slices begin before their planes by what f32 loses: behind the eye, where 1/ζ says nothing.
        let DepthRange { near, far } = body.depth;
        let near = if inverse { near.max(camera.projection.depth_range().0) } else { near };
        let [least, greatest] = if inverse { [1.0 / far, 1.0 / near] } else { [near, far] };
        let mut sheaf = Self { first, steps, low: [least; ALL], high: [greatest; ALL], inverse };
        let eye = camera.eye() - origin;
        body.walls.iter().for_each(|wall| sheaf.clip(wall.truncate(), wall.truncate().dot(eye) + wall.w));
        sheaf
    }

    /// Shortens all rays to what is inside a wall, `at_eye` inside of which the eye is.
    fn clip(&mut self, normal: DVec3, at_eye: f64) {
        let [start, direction] = self.first;
        // (1) and (2): the coefficient of t, the first ray's constant, and what moves from ray to ray.
        let (at_start, along) = (at_eye + normal.dot(start), normal.dot(direction));
        let (coefficient, constant, moving) = if self.inverse { (at_start, along, 1) } else { (along, at_start, 0) };
        let scale = -1.0 / coefficient.abs().max(SMALLEST);
        let [across, down] = self.steps.map(|step| normal.dot(step[moving]) * scale);
        let bounds: [f64; ALL] = core::array::from_fn(|ray| constant * scale + across * COLUMN[ray] + down * ROW[ray]);
        // Plain comparisons: a bound that is not a number bounds nothing.
        if coefficient >= 0.0 {
            for (low, bound) in self.low.iter_mut().zip(bounds) {
                *low = if bound > *low { bound } else { *low };
            }
        } else {
            for (high, bound) in self.high.iter_mut().zip(bounds) {
                *high = if -bound < *high { -bound } else { *high };
            }
        }
    }

    /// The spans of eye depth inside the body, as lines across the light: both ends relative to the eye, and the
    /// length. Rays that miss the body are left out.
    pub(crate) fn spans(&self, across: impl Fn(DVec3) -> DVec2) -> impl Iterator<Item = ([DVec2; 2], f64)> {
        let first = self.first.map(&across);
        let steps = self.steps.map(|step| step.map(&across));
        (0..ALL).filter_map(move |ray| {
            let [low, high] = [self.low[ray], self.high[ray]];
            let [near, far] = if self.inverse { [1.0 / high, 1.0 / low] } else { [low, high] };
            let at = |part: usize| first[part] + steps[0][part] * COLUMN[ray] + steps[1][part] * ROW[ray];
            let length = far - near;
            (low < high && length > 0.0 && length.is_finite())
                .then(|| ([at(0) + at(1) * near, at(0) + at(1) * far], length))
        })
    }
}
