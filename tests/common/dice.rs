//! Numbers that look random and are the same every time.

use antumbra::lab::shapes::Random;
use glam::{DVec3, Vec3};

/// A sequence of them.
pub struct Dice(Random);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(Random::from_state(seed))
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        self.0.below(count)
    }

    /// A number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.range(low, high)
    }

    /// The same in f32, which may round to `high`.
    pub fn single(&mut self, low: f32, high: f32) -> f32 {
        self.between(f64::from(low), f64::from(high)) as f32
    }

    /// A vector in a cube around the origin, of half that size.
    pub fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::from_array(core::array::from_fn(|_| self.single(-size, size)))
    }

    /// A unit vector.
    pub fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let around = self.between(0.0, core::f64::consts::TAU);
        DVec3::new(around.cos(), around.sin(), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    }
}
