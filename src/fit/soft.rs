//! Penumbras: how wide they are, and how wide a map can show them.
//!
//! # References
//! - Fernando, *Percentage-closer soft shadows*, 2005.

use glam::DVec2;

use crate::fit::view::{Fitter, Texels};
use crate::frame::{ShadowFrame, ViewUniforms};
use crate::key::MOST_SOFT;
use crate::report::{Part, Why};

impl Fitter<'_> {
    /// Writes what lookups need of a light of this angular diameter, radians, and says where penumbras end to grow.
    /// `texel` is the size of a texel where w is 1, world units; `depth_range` that of the map.
    pub(crate) fn penumbra(
        &self,
        angle: f32,
        texel: DVec2,
        depth_range: f64,
        uniforms: &mut ViewUniforms,
        frame: &mut ShadowFrame,
    ) {
        // The radius of a penumbra at a distance of one; that of the widest one, in texels.
        let radius = (0.5 * f64::from(angle)).tan();
        let widest = self.texels.widest_penumbra();
        uniforms.moments = [(radius * depth_range) as f32, widest as f32, 0.0, 0.0];
        let apart = widest * texel.min_element() / radius;
        if apart < depth_range {
            frame.leave_out(Part::Penumbra(self.index), Why::PenumbraTooWide { apart });
        }
    }
}

impl Texels {
    /// Radius of the widest disc that the border has room for, texels: what reaches beyond it reads light.
    pub(crate) fn widest_penumbra(&self) -> f64 {
        self.widest_reach().clamp(1.0, MOST_SOFT + 1.0) - 1.0
    }
}
