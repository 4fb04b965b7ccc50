//! What the laboratory renders: triangles in world space, cut-outs, and the objects they belong to.

use std::ops::Range;

use glam::{DVec2, DVec3};

/// A triangle scene in world space (right-handed, y up, lengths in the file's units).
#[derive(Clone, Debug, Default)]
pub struct SceneModel {
    /// Name shown in reports (`treeline`, or the file's stem).
    pub name: String,
    /// Vertex positions in world space.
    pub positions: Vec<DVec3>,
    /// Texture coordinates, one per position; empty when no triangle is cut out.
    pub uvs: Vec<DVec2>,
    /// Three indices into `positions` per triangle, counter-clockwise seen from its front.
    pub triangles: Vec<[u32; 3]>,
    /// Cut-out of each triangle: an index into `cutouts`, or [`SOLID`]; empty when every triangle is solid.
    pub triangle_cutout: Vec<u32>,
    /// Alpha masks (glTF `alphaMode: MASK`).
    pub cutouts: Vec<Cutout>,
    /// The engine's view of the scene: ranges of triangles (one per mesh instance), in order, covering all of them.
    pub objects: Vec<Range<usize>>,
}

/// Marks a triangle without cut-out in [`SceneModel::triangle_cutout`].
pub const SOLID: u32 = u32::MAX;

/// An alpha mask: texels with alpha below the cutoff are holes.
#[derive(Clone, Debug)]
pub struct Cutout {
    /// Width of the mask, texels.
    pub width: u32,
    /// Height of the mask, texels.
    pub height: u32,
    /// Alpha, row 0 first (v = 0 is the top row, as in glTF), `width * height` bytes.
    pub alpha: Vec<u8>,
    /// A point is solid when its bilinearly filtered alpha (0..1) is at least this.
    pub cutoff: f32,
}

impl SceneModel {
    /// Returns the corners of a triangle in world space. Panics when `triangle` is not below `triangles.len()`.
    #[must_use]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|index| self.positions[index as usize])
    }

    /// Returns the least and the greatest corner of the box around all used positions; `None` without triangles.
    #[must_use]
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let used = self.triangles.iter().flatten().map(|&index| self.positions[index as usize]);
        used.fold(None, |bounds, point| match bounds {
            None => Some((point, point)),
            Some((least, greatest)) => Some((point.min(least), point.max(greatest))),
        })
    }

    /// Returns the alpha mask of a triangle; `None` for a solid one.
    #[must_use]
    pub fn cutout(&self, triangle: usize) -> Option<&Cutout> {
        let index = *self.triangle_cutout.get(triangle)?;
        self.cutouts.get(usize::try_from(index).ok()?)
    }

    /// Tells whether there is matter at a point of a triangle, given by the weights of its three corners (sum 1).
    #[must_use]
    pub fn is_solid(&self, triangle: usize, weights: DVec3) -> bool {
        let Some(cutout) = self.cutout(triangle) else { return true };
        let [a, b, c] = self.triangles[triangle].map(|index| self.uvs[index as usize]);
        cutout.is_solid(a * weights.x + b * weights.y + c * weights.z)
    }

    /// Feeds everything that casts or receives a shadow to a hash: geometry and masks, not names or objects.
    pub fn hash_content(&self, hasher: &mut blake3::Hasher) {
        let mut count = |count: usize| _ = hasher.update(&(count as u64).to_le_bytes());
        // Lengths first, so that no two scenes give one stream of bytes.
        [self.positions.len(), self.uvs.len(), self.triangles.len()].into_iter().for_each(&mut count);
        [self.triangle_cutout.len(), self.cutouts.len()].into_iter().for_each(&mut count);
        hasher.update(bytemuck::cast_slice(&self.positions));
        hasher.update(bytemuck::cast_slice(&self.uvs));
        hasher.update(bytemuck::cast_slice(&self.triangles));
        hasher.update(bytemuck::cast_slice(&self.triangle_cutout));
        for cutout in &self.cutouts {
            hasher.update(bytemuck::cast_slice(&[cutout.width, cutout.height, cutout.cutoff.to_bits()]));
            hasher.update(&cutout.alpha);
        }
    }
}

impl Cutout {
    /// Returns the bilinearly filtered alpha, 0 to 1, at texture coordinates that repeat with period 1.
    ///
    /// Texel centres lie at half-integers, so the mask agrees with a GPU sampler in repeat mode at level 0. A mask
    /// without texels is solid.
    #[must_use]
    pub fn alpha(&self, uv: DVec2) -> f64 {
        if self.width == 0 || self.height == 0 || !uv.is_finite() {
            return 1.0;
        }
        // Wrap before scaling: far repeats would lose the fraction.
        let wrapped = uv - uv.floor();
        let texel = wrapped * DVec2::new(f64::from(self.width), f64::from(self.height)) - 0.5;
        let corner = texel.floor();
        let part = texel - corner;
        // The corner lies in -1 ..= size - 1, the far neighbour one further: both wrap around once at most.
        let fetch = |dx: f64, dy: f64| {
            let x = (corner.x + dx).rem_euclid(f64::from(self.width)) as usize;
            let y = (corner.y + dy).rem_euclid(f64::from(self.height)) as usize;
            f64::from(self.alpha[y * self.width as usize + x]) / f64::from(u8::MAX)
        };
        let top = fetch(0.0, 0.0) * (1.0 - part.x) + fetch(1.0, 0.0) * part.x;
        let bottom = fetch(0.0, 1.0) * (1.0 - part.x) + fetch(1.0, 1.0) * part.x;
        top * (1.0 - part.y) + bottom * part.y
    }

    /// Tells whether the mask has matter at these texture coordinates: alpha at least the cutoff.
    #[must_use]
    pub fn is_solid(&self, uv: DVec2) -> bool {
        self.alpha(uv) >= f64::from(self.cutoff)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Cutout {
        Cutout { width: 2, height: 2, alpha: vec![0, 255, 0, 255], cutoff: 0.5 }
    }

    #[test]
    fn alpha_is_exact_at_texel_centres_and_linear_between() {
        let mask = ramp();
        assert!(mask.alpha(DVec2::new(0.25, 0.25)).abs() < 1e-12);
        assert!((mask.alpha(DVec2::new(0.75, 0.75)) - 1.0).abs() < 1e-12);
        assert!((mask.alpha(DVec2::new(0.4, 0.6)) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn alpha_repeats_in_both_directions() {
        let mask = ramp();
        for shift in [-3.0, -1.0, 1.0, 7.0] {
            let uv = DVec2::new(0.9, 0.1);
            assert!((mask.alpha(uv + shift) - mask.alpha(uv)).abs() < 1e-9);
        }
        // Across the seam the last column blends with the first.
        assert!((mask.alpha(DVec2::new(0.0, 0.5)) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn bounds_ignore_unused_positions() {
        let far = DVec3::splat(1e9);
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, far];
        let scene = SceneModel { positions, triangles: vec![[0, 1, 2]], ..SceneModel::default() };
        assert_eq!(scene.bounds(), Some((DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0))));
        assert_eq!(SceneModel::default().bounds(), None);
    }
}
