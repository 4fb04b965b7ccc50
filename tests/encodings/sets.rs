//! Sets of depths as a filter meets them, and their moments.

use antumbra::encoding::convolution::antumbra_convolution_terms;
use antumbra::encoding::exponential::{
    antumbra_exponential_mean, antumbra_exponential_part, antumbra_exponential_variance_moments,
};
use antumbra::encoding::moments::antumbra_moments;
use antumbra::encoding::variance::antumbra_variance_moments;
use glam::{Vec2, Vec4};

use crate::dice::Dice;

/// Depths in [0, 1] and their weights, which sum to 1.
#[derive(Clone, Debug)]
pub(crate) struct Set(pub(crate) Vec<(f32, f32)>);

impl Set {
    /// Equal weights.
    pub(crate) fn even(depths: &[f32]) -> Self {
        Self(depths.iter().map(|depth| (*depth, 1.0 / depths.len() as f32)).collect())
    }

    /// One to nine depths, many of them equal, neighbours in f32, or at an end of the range.
    pub(crate) fn hostile(dice: &mut Dice) -> Self {
        let count = 1 + dice.below(9);
        let base = dice.single(0.0, 1.0);
        let depths: Vec<f32> = (0..count)
            .map(|_| match dice.below(8) {
                0 => 0.0,
                1 => 1.0,
                2 => base,
                3 => base.next_up().min(1.0),
                4 => (base + dice.single(-1e-4, 1e-4)).clamp(0.0, 1.0),
                5 => dice.single(0.0, 1e-6),
                _ => dice.single(0.0, 1.0),
            })
            .collect();
        // Some weigh next to nothing.
        let raw: Vec<f64> = depths.iter().map(|_| dice.between(0.0, 1.0).powf(1.0 + dice.below(8) as f64)).collect();
        let sum: f64 = raw.iter().sum();
        Self(depths.into_iter().zip(raw.into_iter().map(|weight| (weight / sum) as f32)).collect())
    }

    /// A receiver: at a depth of the set, next to one, at an end, or anywhere.
    pub(crate) fn receiver(&self, dice: &mut Dice) -> f32 {
        let one = self.0[dice.below(self.0.len())].0;
        match dice.below(6) {
            0 => one,
            1 => one.next_up(),
            2 => (one + dice.single(-1e-3, 1e-3)).clamp(0.0, 1.0),
            3 => [0.0, 1.0][dice.below(2)],
            _ => dice.single(0.0, 1.0),
        }
    }

    /// Share of the light at a depth: what lies there or behind it.
    pub(crate) fn lit(&self, depth: f32) -> f64 {
        self.0.iter().filter(|(caster, _)| *caster >= depth).map(|(_, weight)| f64::from(*weight)).sum()
    }

    fn mean<T: core::iter::Sum<T>>(&self, of: impl Fn(f32, f32) -> T) -> T {
        self.0.iter().map(|(depth, weight)| of(*depth, *weight)).sum()
    }

    pub(crate) fn variance(&self) -> Vec2 {
        self.mean(|depth, weight| antumbra_variance_moments(depth) * weight)
    }

    pub(crate) fn exponential(&self, exponent: f32) -> f32 {
        let farthest = self.0.iter().map(|(depth, _)| *depth).fold(0.0, f32::max);
        let sum = self.mean(|depth, weight| weight * antumbra_exponential_part(depth, farthest, exponent));
        antumbra_exponential_mean(sum, farthest, exponent)
    }

    pub(crate) fn exponential_variance(&self, exponents: Vec2) -> Vec4 {
        self.mean(|depth, weight| antumbra_exponential_variance_moments(depth, exponents) * weight)
    }

    pub(crate) fn convolution(&self, term: u32) -> Vec4 {
        self.mean(|depth, weight| antumbra_convolution_terms(depth, term) * weight)
    }

    pub(crate) fn moments(&self) -> Vec4 {
        self.mean(|depth, weight| antumbra_moments(depth) * weight)
    }
}
