//! Whether casters lie above one another as the light sees them: only there light can bleed.
//!
//! A map of moments takes what it blurs for two depths at most. It is wrong where it blurs two casters and is read
//! behind both, and light bleeds through the nearer one. Where no two casters come as near to each other, across the
//! light, as what is blurred together, there is nothing to remove, and removing it takes the outer part of penumbras.
//!
//! Boxes projected along the light are hexagons whose sides run along the three edges of a box: two of them are apart
//! if and only if they are apart across one of these (separating axes).
//!
//! # References
//! - Donnelly & Lauritzen, *Variance shadow maps*, 2006: light bleeding. Lauritzen, *Summed-area variance shadow maps*,
//!   GPU Gems 3, 2007: its reduction.

use arrayvec::ArrayVec;
use glam::DVec3;

use crate::encoding::stage::{Encoding, Radius};
use crate::fit::view::Fitter;
use crate::frame::{CullVolume, ShadowFrame, ViewUniforms};
use crate::report::{Part, Why};
use crate::scene::Aabb;

/// Most casters that are compared, each with each: 496 pairs, about a microsecond. With more of them in view some pair
/// is hardly ever apart from all others, and overlap is assumed; at 2 nothing but a lone caster would be known to be
/// alone.
const MOST_CASTERS: usize = 32;

/// By how much of the largest texel over receivers a texel within reach of them may be larger: warps are limited to a
/// half (`ANTUMBRA_MOST_GROWTH`). At 1 a caster behind the rim could be missed; more assumes overlap more often.
const OUTGROWN: f64 = 1.5;

impl Fitter<'_> {
    /// Leaves out the reduction of bleeding where no two of the engine's objects can bleed through each other.
    /// `largest` is the side of the largest texel, world units; `cull` passes what may cast into the map.
    pub(crate) fn bleeding(
        &self,
        largest: f32,
        cull: &CullVolume,
        uniforms: &mut ViewUniforms,
        frame: &mut ShadowFrame,
    ) {
        let Encoding::Moments(prefilter) = self.encoding else { return };
        if prefilter.dark <= 0.0 {
            return;
        }
        // What is read around a receiver: the blur, a texel of interpolation, and texels of the smallest level.
        let texels = f64::from(self.texels.kernel()) + 1.0 + f64::from(uniforms.moments[1]).exp2();
        let world = match prefilter.radius {
            Radius::World(radius) => f64::from(radius),
            Radius::Texels(_) => 0.0,
        };
        let reach = (texels * f64::from(largest) * OUTGROWN).max(world);
        let objects = self.input.scene.objects;
        let casters = objects.iter().filter(|object| object.casts && cull.may_cast(&object.bounds));
        if !objects.is_empty() && lie_apart(self.travel, casters.map(|object| &object.bounds), 2.0 * reach) {
            uniforms.moments[0] = 0.0;
            frame.leave_out(Part::Bleeding(self.index), Why::NothingOverlaps);
        }
    }
}

/// Whether light of this direction sees all boxes farther apart than `gap`, world units; no for more than
/// [`MOST_CASTERS`]. O(1) for each box.
fn lie_apart<'a>(travel: DVec3, boxes: impl Iterator<Item = &'a Aabb>, gap: f64) -> bool {
    let across = DVec3::AXES.map(|edge| travel.cross(edge));
    // Middle and half the extent along each of the three.
    let mut seen = ArrayVec::<(DVec3, DVec3), MOST_CASTERS>::new();
    for bounds in boxes {
        let (centre, half) = (bounds.centre(), bounds.half_size());
        let middle = DVec3::from(across.map(|axis| axis.dot(centre)));
        let extent = DVec3::from(across.map(|axis| axis.abs().dot(half) + 0.5 * gap * axis.length()));
        // A NaN is apart from nothing.
        let apart = |other: &(DVec3, DVec3)| (middle - other.0).abs().cmpgt(extent + other.1).any();
        if !seen.iter().all(apart) || seen.try_push((middle, extent)).is_err() {
            return false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn apart(travel: DVec3, boxes: &[Aabb], gap: f64) -> bool {
        lie_apart(travel.normalize(), boxes.iter(), gap)
    }

    #[test]
    fn boxes_are_apart_by_the_gap_and_no_more() {
        let cube = |x: f64, y: f64| Aabb::new(DVec3::new(x, y, 0.0), DVec3::new(x + 1.0, y + 1.0, 1.0));
        let two = [cube(0.0, 0.0), cube(3.0, 0.0)];
        assert!(apart(DVec3::NEG_Y, &two, 1.99) && !apart(DVec3::NEG_Y, &two, 2.01));
        // Above one another, or not, as the light falls.
        let high = [cube(0.0, 0.0), cube(3.0, 5.0)];
        assert!(apart(DVec3::NEG_Y, &high, 0.5) && !apart(DVec3::new(-3.0, -5.0, 0.0), &high, 0.5));
        // Along a diagonal neither their bounds in space nor those of their shadows tell them apart: their hexagons.
        let steps = [cube(0.0, 0.0), cube(1.2, 1.2)];
        assert!(apart(DVec3::new(1.0, -1.0, 0.0), &steps, 0.2) && !apart(DVec3::new(1.0, -1.0, 0.0), &steps, 0.4));
        // A row of as many as are compared, and one more.
        let row: Vec<_> = (0..=MOST_CASTERS).map(|index| cube(2.0 * index as f64, 0.0)).collect();
        assert!(apart(DVec3::NEG_Y, &row[1..], 0.5) && !apart(DVec3::NEG_Y, &row, 0.5));
        let broken = Aabb::new(DVec3::splat(f64::NAN), DVec3::splat(f64::NAN));
        assert!(!apart(DVec3::NEG_Y, &[two[0], broken], 0.0));
    }

    proptest! {
        /// Boxes that one ray meets are never apart; boxes that are have no two points within the gap across the light.
        #[test]
        fn what_a_ray_meets_is_not_apart(
            travel in prop::array::uniform3(-1.0..1.0_f64), corners in prop::array::uniform4(prop::array::uniform3(-5.0..5.0_f64)),
            shares in prop::array::uniform6(0.0..=1.0_f64), gap in 0.0..2.0_f64,
        ) {
            let travel = DVec3::from(travel);
            prop_assume!(travel.length() > 0.01);
            let travel = travel.normalize();
            let [a, b, c, d] = corners.map(DVec3::from);
            let boxes = [(a, b), (c, d)].map(|(one, other)| Aabb::new(one.min(other), one.max(other)));
            let [x, y, z, u, v, w] = shares;
            let at = |bounds: &Aabb, shares| bounds.min + (bounds.max - bounds.min) * shares;
            let between = at(&boxes[0], DVec3::new(x, y, z)) - at(&boxes[1], DVec3::new(u, v, w));
            let across = between - travel * travel.dot(between);
            if apart(travel, &boxes, gap) {
                prop_assert!(across.length() >= gap * (1.0 - 1e-9), "{} of {gap}", across.length());
            }
        }
    }
}
