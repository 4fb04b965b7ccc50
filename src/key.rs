//! Which shader text a technique needs: what texels store, how they are found and how they are read.

use crate::grazing::Grazing;
use crate::texel::Texel;

/// Which shader text a technique needs: small and plain; compare it with the key a pipeline was built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WgslKey {
    /// What a texel of the map stores that receivers read.
    pub texel: Texel,
    /// How depths are compared; [`Pcf::Hardware2x2`] for moments, which are not compared.
    pub filter: Pcf,
    /// Whether positions are divided by w on their way into the map.
    pub shape: MapShape,
    /// Most maps of a frame, 1 to [`MAX_VIEWS`](crate::MAX_VIEWS): the length of the uniform array, and the most
    /// layers. 1 is a plain map, and a shader without arrays or loops.
    pub maps: u8,
    /// How a receiver finds its map among several; [`Select::Depth`] for one map.
    pub select: Select,
    /// Whether neighbouring maps are blended into each other; never for one map.
    pub blend: bool,
    /// What stands in for the maps where the light grazes a surface.
    pub grazing: Grazing,
}

impl Default for WgslKey {
    fn default() -> Self {
        Self {
            texel: Texel::default(),
            filter: Pcf::default(),
            shape: MapShape::default(),
            maps: 1,
            select: Select::default(),
            blend: false,
            grazing: Grazing::Off,
        }
    }
}

/// How a receiver finds its map among several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Select {
    /// By its eye depth: one comparison a map, one lookup.
    #[default]
    Depth,
    /// The finest map that holds it and what its filter reads: near maps reach beyond their own depths. One lookup
    /// position a map until it is found.
    Finest,
}

impl Select {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Depth, Self::Finest];
}

/// The kind of transformation that leads into a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MapShape {
    /// Affine, w = 1: uniform maps. Casters need no fragment shader.
    #[default]
    Affine,
    /// Projective, texels hold linear depth: warped maps. Casters write their depth in a fragment shader.
    Projective,
    /// Projective, texels hold linear depth over w: warped maps whose casters need no fragment shader.
    ProjectiveDepth,
}

impl MapShape {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Affine, Self::Projective, Self::ProjectiveDepth];

    /// Whether casters write [`ShadowView::depth_from_render`](crate::ShadowView::depth_from_render) as their depth,
    /// instead of leaving z to the rasteriser.
    #[must_use]
    pub const fn writes_depth(self) -> bool {
        matches!(self, Self::Projective)
    }
}

/// Percentage-closer filters: compare first, then average.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pcf {
    /// The nearest texel alone: one texture sample, hard edges.
    Point,
    /// The four nearest texels, bilinearly weighted by the sampler hardware: one texture sample.
    #[default]
    Hardware2x2,
    /// Four bilinear samples over the part of the map that the pixel covers: one bilinear sample where texels are
    /// larger than pixels, the mean of what the pixel shows where they are smaller
    /// ([`pixel`](crate::encoding::pixel)). Its taps know their own depths, so that it needs the bias and the border of
    /// one sample.
    Pixel,
    /// A box three texels wide: 4 texture samples.
    Box3x3,
    /// A box five texels wide: 9 texture samples.
    Box5x5,
    /// A box seven texels wide: 16 texture samples.
    Box7x7,
    /// A disc of three texels' radius: 12 texture samples in a spiral, which the engine may turn from pixel to pixel
    /// (`antumbra_visibility_noisy`).
    Disc,
    /// Percentage-closer soft shadows: hard at contacts, and the softer the farther away casters are, as
    /// [`Encoding::Soft`](crate::Encoding::Soft) says. 16 texels searched for casters, and where there are any, 16
    /// texture samples over a disc, which the engine may turn. Depths are read as well as compared with, which GLSL
    /// cannot ([`reads_depths`](Self::reads_depths)).
    Pcss,
}

impl Pcf {
    /// All of them, cheapest first.
    pub const ALL: [Self; 8] =
        [Self::Point, Self::Hardware2x2, Self::Box3x3, Self::Pixel, Self::Box5x5, Self::Disc, Self::Box7x7, Self::Pcss];

    /// Distance in texels, along an axis of the map, from a point to the farthest texel centre that its filter reads.
    /// Point: ½ (the texel the point lies in); bilinear: 1; an n×n box of bilinear samples: (n + 1)/2; a disc
    /// of them: its radius and 1. Taps over the pixel that lie beyond the map are not read: those of one bilinear
    /// sample.
    #[must_use]
    pub const fn reach(self) -> f64 {
        match self {
            Self::Point => 0.5,
            Self::Hardware2x2 | Self::Pixel => 1.0,
            Self::Box3x3 => 2.0,
            Self::Box5x5 => 3.0,
            Self::Box7x7 | Self::Disc => 4.0,
            Self::Pcss => MOST_SOFT + 1.0,
        }
    }

    /// The same for one sample of the filter, which knows the receiver's plane at its own place.
    #[must_use]
    pub const fn tap_reach(self) -> f64 {
        match self {
            Self::Point => 0.5,
            _ => 1.0,
        }
    }

    /// Texture samples of one lookup, at most.
    #[must_use]
    pub const fn samples(self) -> u32 {
        match self {
            Self::Point | Self::Hardware2x2 => 1,
            Self::Box3x3 | Self::Pixel => 4,
            Self::Box5x5 => 9,
            Self::Disc => 12,
            Self::Box7x7 | Self::Pcss => 16,
        }
    }

    /// Whether its taps lie on a disc that noise may turn: the text has `antumbra_visibility_noisy`.
    #[must_use]
    pub const fn is_disc(self) -> bool {
        matches!(self, Self::Disc | Self::Pcss)
    }

    /// Whether its taps lie where the receiver's surroundings say: the text needs more than a place in the map.
    #[must_use]
    pub const fn is_spread(self) -> bool {
        matches!(self, Self::Disc | Self::Pcss | Self::Pixel)
    }

    /// Whether depths are read as they are, besides being compared with: there is no GLSL for it, whose textures of
    /// depths are for one of the two.
    #[must_use]
    pub const fn reads_depths(self) -> bool {
        matches!(self, Self::Pcss)
    }

    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Hardware2x2 => "pcf2x2",
            Self::Pixel => "pixel",
            Self::Box3x3 => "pcf3x3",
            Self::Box5x5 => "pcf5x5",
            Self::Box7x7 => "pcf7x7",
            Self::Disc => "disc",
            Self::Pcss => "pcss",
        }
    }
}

/// Largest radius of the disc of [`Pcf::Pcss`], texels. More would show the grain of 16 taps and take a wider border
/// from every map; less would make distant shadows no softer than boxes do.
pub(crate) const MOST_SOFT: f64 = 16.0;
