//! A light that is seen as a disc: the rays to it from a point.
//!
//! # References
//! - Vogel, *A better way to construct the sunflower head*, 1979 (points spread evenly over a disc).

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::lab::bvh::Ray;
use crate::lab::shapes::Random;

/// Rays to the disc from a pixel's centre. The share above a straight edge is then off by 0.01 in the mean
/// (`tests/soft_truth.rs`); 16 would leave three times as much, 256 would cost four times the time.
pub(super) const CENTRE_RAYS: u32 = 64;

/// Rays to the disc from each sample of a pixel's area, each turned by another angle: 256 in all at least.
pub(super) const AREA_RAYS: u32 = 16;

/// The disc of a light, as seen from anywhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightDisc {
    /// Radius of the disc at a distance of one; 0 for a light without size.
    radius: f64,
}

impl LightDisc {
    /// The disc that is `angle` radians wide.
    pub(super) fn new(angle: f64) -> Self {
        Self { radius: (0.5 * angle).tan() }
    }

    /// Mean over the disc of what `is_lit` says of rays to it, for the ray to its middle and the normal of the surface
    /// that it starts on. What lies below the surface's plane does not count: there the surface turns away, and nothing
    /// shades it. `place` picks the turn of the rays: any two numbers that are the same on every run.
    pub(super) fn mean(
        self,
        middle: &Ray,
        normal: DVec3,
        count: u32,
        place: [f64; 2],
        is_lit: impl Fn(&Ray) -> bool,
    ) -> f32 {
        let share = |lit: bool| f32::from(u8::from(lit));
        if self.radius == 0.0 {
            return share(is_lit(middle));
        }
        let (across, other) = middle.direction.normalize().any_orthonormal_pair();
        let radius = self.radius * middle.direction.length();
        let turn = turn(place);
        let (mut lit, mut faced) = (0.0, 0.0);
        for index in 0..count {
            let (sin, cos) = (turn + f64::from(index) * GOLDEN_ANGLE).sin_cos();
            let out = radius * ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
            let direction = middle.direction + (across * cos + other * sin) * out;
            if normal.dot(direction) > 0.0 {
                lit += share(is_lit(&Ray { direction, ..*middle }));
                faced += 1.0;
            }
        }
        // The middle is faced, whatever the points around it are.
        if faced > 0.0 { lit / faced } else { share(is_lit(middle)) }
    }
}

/// The golden angle π(3 − √5), radians.
const GOLDEN_ANGLE: f64 = PI * 0.763_932_022_500_210_3;

/// A turn for a place in the picture, radians.
fn turn(place: [f64; 2]) -> f64 {
    let [x, y] = place.map(f64::to_bits);
    let bits = Random::new(x ^ y.rotate_left(32)).bits();
    TAU * (bits >> 11) as f64 / (1_u64 << 53) as f64
}
