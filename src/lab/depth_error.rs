//! The error of a map over depth in one dimension: how far a step in the map goes in the picture, for maps that lay a
//! range of depths out uniformly, logarithmically or by a projection.
//!
//! E(z) = (dz/ds) / z, with s from 0 to 1 over the map. ∫ dz / (z E(z)) = 1 for every layout:
//! nothing is gained in sum, only moved.
//!
//! # References
//! - Chong, *Real-time perspective optimal shadow maps*, 2003, and Lloyd, Govindaraju, Quammen, Molnar & Manocha,
//!   *Logarithmic perspective shadow maps*, 2008: the metric, without its factor 2 tan θ.

/// How a map lays out a range of depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layout {
    /// Equal steps of depth.
    Uniform,
    /// Equal ratios of depth: the error is the same everywhere.
    Logarithmic,
    /// As a projection sees them.
    Projection {
        /// Its centre's distance behind the eye, in units of depth, >= 0: 0 is the eye itself, far behind is uniform.
        pull_back: f64,
    },
}

impl Layout {
    /// E(z) for the range of depths [near, far], 0 < near < far, at near <= z <= far.
    #[must_use]
    pub fn error(self, [near, far]: [f64; 2], z: f64) -> f64 {
        match self {
            Self::Uniform => (far - near) / z,
            Self::Logarithmic => (far / near).ln(),
            Self::Projection { pull_back } => {
                (far - near) * (z + pull_back).powi(2) / ((near + pull_back) * (far + pull_back) * z)
            }
        }
    }
}

/// Halvings of an interval of depths: more than a double tells apart.
const HALVINGS: u32 = 200;

/// The depth in [`low`, `high`] at which two layouts of `range` err alike;
/// `None` where one is the better one at both ends.
#[must_use]
pub fn crossing(a: Layout, b: Layout, range: [f64; 2], [mut low, mut high]: [f64; 2]) -> Option<f64> {
    let above = |z| a.error(range, z) > b.error(range, z);
    let at_low = above(low);
    if at_low == above(high) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if above(middle) == at_low { low = middle } else { high = middle }
    }
    Some(low)
}
