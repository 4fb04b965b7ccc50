//! The passes that make a summed-area table.
//!
//! As many along each axis as eight has to be multiplied with itself to reach the tile's side: each adds eight sums of
//! the one before it. They go to and fro between the map and the texture beside it.

use super::{Pass, Prefilter};
use crate::frame::ShadowView;
use crate::texel::SUMMED_TEXELS;

/// Passes along an axis that sum a tile of this side.
pub(super) fn sums(side: u32) -> u32 {
    side.saturating_sub(1).checked_ilog(SUMMED_TEXELS).map_or(1, |whole| whole + 1)
}

impl Prefilter {
    /// Sums one view: even passes into the texture beside the map, odd ones into the map, with which they end.
    pub(super) fn sum<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (index, view): (usize, &ShadowView),
        next: &mut dyn FnMut() -> Option<wgpu::RenderPassTimestampWrites<'a>>,
    ) {
        let Some(depths) = self.depths.get(view.layer as usize) else { return };
        let Some((map, map_group)) = self.levels.get(view.layer as usize).and_then(|levels| levels.first()) else {
            return;
        };
        let sums = sums(view.blur.tile[2]);
        for number in 0..2 * sums {
            let pipeline = match number {
                0 => &self.along_u,
                _ if number < sums => &self.further,
                _ => &self.along_v,
            };
            let (target, source) =
                if number % 2 == 0 { (&self.scratch, map_group) } else { (map, &self.scratch_group) };
            let group = (if number == 0 { depths } else { source }, self.offset(index, number % sums));
            Pass { pipeline, group, target, tile: view.blur.tile }.record(encoder, next());
        }
    }
}
