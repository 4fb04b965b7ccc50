//! What has become of a map since last frame: data for engines that keep the maps of still scenes.
//!
//! # References
//! - Acton, *Scrolling cascaded shadow maps*, 2012 (cached cascades that move by whole texels are shifted, and redrawn
//!   along two strips).

use glam::{DVec2, DVec3, IVec2, UVec2};

use crate::texel::{BlurUniforms, Texel};

/// What an engine has to draw of a map whose casters have not moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Content {
    /// All of it: there was no such map, or its texels lie elsewhere.
    #[default]
    Redraw,
    /// Nothing: its texels hold what they did.
    Unchanged,
    /// What has come into view: the texel at (x, y) holds what the one at (x, y) + `texels` held, both counted from the
    /// upper left corner of the view's viewport.
    Scrolled {
        /// Whole texels, x to the right and y down.
        texels: IVec2,
    },
}

/// Where a map's texels are in the world, whatever render space was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Directions of the map's sides, and of light.
    pub(crate) axes: [DVec3; 3],
    /// Size of a texel, world units.
    pub(crate) texel: DVec2,
    /// Lower corner of the window across the light, world units.
    pub(crate) low: DVec2,
    /// Nearest and farthest depth along the light, world units.
    pub(crate) depth: [f64; 2],
    /// Its texels in the layers.
    pub(crate) tile: Tile,
    /// Whether texels are all of one size.
    pub(crate) uniform: bool,
    /// Last level of the mip chain that is read.
    pub(crate) levels: f32,
    /// What its texels are made of.
    pub(crate) made: Made,
}

/// What the texels of a map are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Made {
    /// What they store.
    texel: Texel,
    /// Half-width and shape of the blur, as its passes know them.
    radius: f32,
    bell: u32,
}

impl Made {
    /// By the passes of a blur. Sums are of all texels, however wide they are read.
    pub(crate) fn by(texel: Texel, blur: &BlurUniforms) -> Self {
        let is_summed = matches!(texel, Texel::Moments(moments) if moments.is_summed());
        Self { texel, radius: if is_summed { 0.0 } else { blur.radius }, bell: blur.bell }
    }
}

impl Place {
    /// Of a map that is drawn anew in every frame.
    pub(crate) const UNKNOWN: Self = Self {
        axes: [DVec3::ZERO; 3],
        texel: DVec2::ZERO,
        low: DVec2::ZERO,
        depth: [0.0; 2],
        tile: Tile::whole(0, 0),
        uniform: false,
        levels: 0.0,
        made: Made { texel: Texel::Depth, radius: 0.0, bell: 0 },
    };
}

/// The texels of a map: a square of a layer, or all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    /// Array layer.
    pub(crate) layer: u32,
    /// Upper left corner in the layer, texels.
    pub(crate) corner: UVec2,
    /// Texels along a side.
    pub(crate) side: u32,
    /// Texels along a side of the layer.
    pub(crate) of: u32,
}

impl Tile {
    /// All of a layer.
    pub(crate) const fn whole(layer: u32, side: u32) -> Self {
        Self { layer, corner: UVec2::ZERO, side, of: side }
    }

    /// How often the layer's side was halved for it.
    pub(crate) fn halvings(self) -> u32 {
        (0..u32::BITS).find(|halvings| self.of >> halvings <= self.side).unwrap_or(0)
    }
}

/// Parts of a texel, and of the depth range, by which places may differ and be the same: rounding of f64 far from the
/// origin. What f32 makes of a thousandth is in every bias; more would show as a shift.
const SAME: f64 = 1e-3;

/// Most texels that a map can scroll by and keep any.
const MOST_TEXELS: f64 = 16_384.0;

impl Content {
    /// Of a map at `now` that was at `before`.
    pub(crate) fn since(before: &Place, now: &Place) -> Self {
        let range = (now.depth[1] - now.depth[0]).abs();
        let close = |a: f64, b: f64, unit: f64| (a - b).abs() <= SAME * unit;
        let depths = now.depth.iter().zip(before.depth).all(|(now, before)| close(*now, before, SAME * range));
        let same = now.uniform && before.uniform && now.axes == before.axes && now.tile == before.tile && depths;
        // Levels that were not read may not have been made.
        let same = same && now.levels <= before.levels && now.made == before.made;
        // The far side of the map is off by as many parts of a texel as there are texels.
        let texels = (now.texel - before.texel).abs() * f64::from(now.tile.side);
        if !same || texels.cmpgt(now.texel * SAME).any() {
            return Self::Redraw;
        }
        let moved = (now.low - before.low) / now.texel;
        let whole = moved.round();
        if (moved - whole).abs().max_element() > SAME || whole.abs().max_element() >= MOST_TEXELS {
            return Self::Redraw;
        }
        // Rows count from the top.
        match IVec2::new(whole.x as i32, -whole.y as i32) {
            IVec2::ZERO => Self::Unchanged,
            texels => Self::Scrolled { texels },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place() -> Place {
        let axes = [DVec3::X, DVec3::Z, DVec3::NEG_Y];
        Place {
            axes,
            texel: DVec2::splat(0.25),
            low: DVec2::new(-3.0, 7.0),
            depth: [0.0, 50.0],
            tile: Tile::whole(0, 512),
            uniform: true,
            ..Place::UNKNOWN
        }
    }

    #[test]
    fn whole_texels_scroll_and_parts_do_not() {
        let moved = |x: f64, y: f64| Place { low: place().low + DVec2::new(x, y), ..place() };
        assert_eq!(Content::since(&place(), &place()), Content::Unchanged);
        assert_eq!(Content::since(&place(), &moved(0.5, 0.0)), Content::Scrolled { texels: IVec2::new(2, 0) });
        assert_eq!(Content::since(&place(), &moved(-0.25, 1.0)), Content::Scrolled { texels: IVec2::new(-1, -4) });
        assert_eq!(Content::since(&place(), &moved(0.1, 0.0)), Content::Redraw);
        assert_eq!(Content::since(&place(), &moved(1e300, 0.0)), Content::Redraw);
    }

    #[test]
    fn other_maps_are_drawn_again() {
        for other in [
            Place { axes: [DVec3::Z, DVec3::X, DVec3::NEG_Y], ..place() },
            Place { texel: DVec2::splat(0.3), ..place() },
            Place { depth: [0.0, 60.0], ..place() },
            Place { tile: Tile::whole(0, 1024), ..place() },
            Place { tile: Tile::whole(1, 512), ..place() },
            Place { tile: Tile { of: 1024, ..Tile::whole(0, 512) }, ..place() },
            Place { uniform: false, ..place() },
            Place { levels: 1.0, ..place() },
        ] {
            assert_eq!(Content::since(&place(), &other), Content::Redraw, "{other:?}");
        }
    }
}
