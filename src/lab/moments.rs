//! Maps of moments in memory, filtered as the passes on a GPU do it: what the software renderer reads, and what those
//! passes are compared with.

use glam::{IVec2, UVec2, UVec4, Vec2, Vec4};
use half::f16;
use rayon::prelude::*;

use crate::encoding::blur::{Mean, antumbra_blur_radius, antumbra_blur_reach, antumbra_blur_weight};
use crate::encoding::depth::CompareMap;
use crate::encoding::read::antumbra_store;
use crate::encoding::summed::{ANTUMBRA_BOX_STEPS, antumbra_counted};
use crate::frame::ShadowView;
use crate::texel::{BlurUniforms, MomentFormat, MomentKind, Moments};

/// A layer of moments, with its mip chain.
#[derive(Clone, Debug)]
pub struct MomentMap {
    moments: Moments,
    side: usize,
    /// For each pair of terms of a series (one for everything else) the levels, each row by row.
    pairs: Vec<Vec<Vec<Vec4>>>,
    /// Of sums, what is summed up to each texel of its tile: `pairs` are single texels then.
    sums: Vec<UVec4>,
}

/// What a sampler keeps of the fraction between texels.
const SUB_TEXELS: f32 = 256.0;

impl MomentMap {
    /// An empty layer.
    #[must_use]
    pub fn new(moments: Moments, side: u32) -> Self {
        let levels = (0..=moments.last_level(side)).map(|level| {
            let side = (side >> level).max(1) as usize;
            vec![Vec4::ZERO; side * side]
        });
        let levels: Vec<_> = levels.collect();
        let sums = vec![UVec4::ZERO; if moments.is_summed() { (side * side) as usize } else { 0 }];
        Self { moments, side: side as usize, pairs: vec![levels; moments.layers() as usize], sums }
    }

    /// Filters the tile of a view from the layer of depths that it was drawn into; call [`halve`](Self::halve) when
    /// all views of the layer are filtered.
    pub fn filter(&mut self, depths: &[f32], view: &ShadowView) {
        if self.moments.is_summed() {
            return self.sum(depths, &view.blur);
        }
        for pair in 0..self.pairs.len() {
            let blur = BlurUniforms { first_term: 2 * pair as u32, ..view.blur };
            self.filter_pair(depths, &blur, pair);
        }
    }

    fn filter_pair(&mut self, depths: &[f32], blur: &BlurUniforms, pair: usize) {
        let (moments, side) = (self.moments, self.side);
        let [left, top, tile, _] = blur.tile.map(|length| length as usize);
        // Along u.
        let stored = |x: usize, y: usize| {
            let depth = sound(depths[(top + y) * side + left + x]);
            antumbra_store(moments, depth, blur.first_term)
        };
        let along_u: Vec<Vec4> = (0..tile * tile)
            .into_par_iter()
            .map(|index| {
                let (x, y) = (index % tile, index / tile);
                let radius = antumbra_blur_radius(blur, Vec2::new(x as f32, y as f32)).x;
                self.averaged(blur, radius, |offset| stored(within(x, offset, tile), y))
            })
            .collect();
        // Along v.
        let along_v: Vec<Vec4> = (0..tile * tile)
            .into_par_iter()
            .map(|index| {
                let (x, y) = (index % tile, index / tile);
                let radius = antumbra_blur_radius(blur, Vec2::new(x as f32, y as f32)).y;
                self.averaged(blur, radius, |offset| along_u[within(y, offset, tile) * tile + x])
            })
            .collect();
        for (row, texels) in along_v.chunks_exact(tile).enumerate() {
            let start = (top + row) * side + left;
            self.pairs[pair][0][start..start + tile].copy_from_slice(texels);
        }
    }

    /// Sums of all texels of a tile up to each of them, row by row.
    fn sum(&mut self, depths: &[f32], blur: &BlurUniforms) {
        let [left, top, tile, _] = blur.tile.map(|length| length as usize);
        let mut above = vec![UVec4::ZERO; tile];
        for y in top..top + tile {
            let mut row = UVec4::ZERO;
            for (x, above) in (left..left + tile).zip(&mut above) {
                let index = y * self.side + x;
                let counted = antumbra_counted(antumbra_store(self.moments, sound(depths[index]), 0));
                self.pairs[0][0][index] = counted.as_vec4() / ANTUMBRA_BOX_STEPS;
                row = row.wrapping_add(counted);
                *above = above.wrapping_add(row);
                self.sums[index] = *above;
            }
        }
    }

    /// A mean along one axis, as its format keeps it.
    fn averaged(&self, blur: &BlurUniforms, radius: f32, at: impl Fn(i32) -> Vec4) -> Vec4 {
        let bell = blur.bell != 0;
        let reach = antumbra_blur_reach(radius, bell);
        let exponent = self.exponent();
        let mean = (-reach..=reach).fold(Mean::default(), |mean, offset| {
            mean.with(at(offset), antumbra_blur_weight(offset as f32, radius, bell), exponent)
        });
        kept(self.moments.format(), mean.value(exponent))
    }

    fn exponent(&self) -> Option<f32> {
        (self.moments.kind() == MomentKind::Exponential).then(|| self.moments.exponent())
    }

    /// Makes the mip chain.
    pub fn halve(&mut self) {
        let (exponent, format) = (self.exponent(), self.moments.format());
        for levels in &mut self.pairs {
            for level in 1..levels.len() {
                let (above, side) = ((self.side >> (level - 1)).max(1), (self.side >> level).max(1));
                let (before, after) = levels.split_at_mut(level);
                let source = &before[level - 1];
                for (index, texel) in after[0].iter_mut().enumerate() {
                    let first = [2 * (index % side), 2 * (index / side)];
                    let mean = (0..4).fold(Mean::default(), |mean, corner| {
                        let [x, y] = [first[0] + corner % 2, first[1] + corner / 2].map(|at| at.min(above - 1));
                        mean.with(source[y * above + x], 1.0, exponent)
                    });
                    *texel = kept(format, mean.value(exponent));
                }
            }
        }
    }

    /// What a texel of a level stores, of the `pair`th two terms of a series; of sums, what it adds to them.
    #[must_use]
    pub fn texel(&self, pair: usize, level: usize, at: UVec2) -> Vec4 {
        self.pairs[pair][level][at.y as usize * (self.side >> level).max(1) + at.x as usize]
    }

    fn in_level(&self, uv: Vec2, level: usize, pair: usize) -> Vec4 {
        let side = (self.side >> level).max(1);
        let at = uv * side as f32 - 0.5;
        let first = at.floor();
        let share = at - first;
        let share = if self.moments.linear { (share * SUB_TEXELS).round() / SUB_TEXELS } else { share };
        let last = UVec2::splat(side as u32 - 1).as_ivec2();
        let low = first.clamp(Vec2::splat(-1.0), Vec2::splat(side as f32)).as_ivec2();
        let texel = |dx, dy| {
            let at = (low + IVec2::new(dx, dy)).clamp(IVec2::ZERO, last).as_uvec2();
            self.texel(pair, level, at)
        };
        let above = texel(0, 0).lerp(texel(1, 0), share.x);
        let below = texel(0, 1).lerp(texel(1, 1), share.x);
        above.lerp(below, share.y)
    }
}

impl CompareMap for MomentMap {
    fn sum(&self, texel: IVec2) -> UVec4 {
        let at = texel.max(IVec2::ZERO).as_uvec2().min(self.size() - 1);
        self.sums.get(at.y as usize * self.side + at.x as usize).copied().unwrap_or_default()
    }

    fn size(&self) -> UVec2 {
        UVec2::splat(self.side as u32)
    }

    /// Moments are not compared.
    fn sample_compare(&self, _uv: Vec2, _depth: f32) -> f32 {
        1.0
    }

    fn stored(&self, uv: Vec2, level: f32, pair: u32) -> Vec4 {
        let levels = &self.pairs[(pair as usize).min(self.pairs.len() - 1)];
        let fine = (level as usize).min(levels.len() - 1);
        let share = level - fine as f32;
        let pair = pair as usize;
        if share <= 0.0 || fine + 1 >= levels.len() {
            return self.in_level(uv, fine, pair);
        }
        self.in_level(uv, fine, pair).lerp(self.in_level(uv, fine + 1, pair), share)
    }
}

/// A depth that is one: anything else is as far as can be.
fn sound(depth: f32) -> f32 {
    if (0.0..=1.0).contains(&depth) { depth } else { 1.0 }
}

/// A place in a tile that stays in it.
fn within(at: usize, offset: i32, tile: usize) -> usize {
    at.saturating_add_signed(offset as isize).min(tile - 1)
}

/// Numbers as a format keeps them.
fn kept(format: MomentFormat, value: Vec4) -> Vec4 {
    let integer = |steps: f32| (value.clamp(Vec4::ZERO, Vec4::ONE) * steps).round() / steps;
    match format {
        MomentFormat::Float32 => value,
        MomentFormat::Float16 => Vec4::from_array(value.to_array().map(|number| f16::from_f32(number).to_f32())),
        MomentFormat::Unorm16 | MomentFormat::Summed => integer(f32::from(u16::MAX)),
        MomentFormat::Unorm8 => integer(f32::from(u8::MAX)),
    }
}
