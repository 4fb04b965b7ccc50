//! What a frame did without, and why. Nothing is dropped silently.

use core::fmt;

/// The part of the plan that was left out, clamped or replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// All maps of this light.
    Light,
    /// The part of the view frustum that lies outside `scene.visible_depth`.
    Frustum,
    /// A split, counted from the nearest one on: it has no map.
    Split(u8),
    /// Receivers of a view that need no texel.
    Receivers(u8),
    /// Stabilisation of a view.
    Stabilise(u8),
    /// The extent of a view across the light.
    Window(u8),
    /// The border of texels around a view's window.
    Border(u8),
    /// Smaller copies of a view's map.
    Levels(u8),
    /// The warp of a view, or a part of its strength.
    Warp(u8),
    /// Texels of a view.
    Texels(u8),
    /// Width of the penumbras of a view.
    Penumbra(u8),
    /// Width of the blur of a view's moments.
    Blur(u8),
    /// The fading of shadows at the visible depth ([`DepthSplits::fade`](crate::DepthSplits::fade)).
    Fade,
    /// Reduction of light bleeding ([`Prefilter::dark`](crate::Prefilter::dark)) in a view.
    Bleeding(u8),
}

/// Why it was left out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Why {
    /// The scene says that it holds no receivers.
    NoReceivers,
    /// The scene says that it holds no casters.
    NoCasters,
    /// No receiver lies in the view frustum between these eye depths (world units).
    NoReceiversInView {
        /// Nearest eye depth looked at.
        near: f64,
        /// Farthest eye depth looked at; may be infinite.
        far: f64,
    },
    /// Nothing that casts stands between the light and the receivers in view.
    NothingCastsHere,
    /// Its planes coincide, or lie outside of the eye depths that are served.
    NoDepth,
    /// The map of this view serves its receivers as well.
    ServedBy {
        /// Number of the view.
        view: u8,
    },
    /// The map of this split has texels that are hardly larger, or too small to be seen, and serves its receivers as
    /// well.
    MetBy {
        /// Number of the split.
        split: u8,
    },
    /// The budget has no map left (`map.views`, `map.layers`).
    NoMapLeft,
    /// The visible depth range holds no depth of the frustum.
    OutsideVisibleDepth {
        /// Nearest visible eye depth, world units.
        near: f64,
        /// Farthest visible eye depth, world units.
        far: f64,
    },
    /// Only these eye depths were asked for (`scene.visible_depth`).
    NotVisible {
        /// Nearest eye depth that is served, world units.
        near: f64,
        /// Farthest eye depth that is served, world units; may be infinite.
        far: f64,
    },
    /// The shadow of the casters' bounds covers only a part of the receivers in view; the rest is lit without a lookup.
    LitWithoutLookup,
    /// The body has no extent across the light (edge-on, or a point); it was widened to this many world units.
    Degenerate {
        /// The least extent that positions near the body can express, world units.
        widened_to: f64,
    },
    /// What is in view is nearly the whole scene: a map of the scene, which does not move with the camera and can be
    /// kept while the scene is still, has texels that are hardly larger.
    SceneIsInView {
        /// Area of the focused window over that of the scene's, 0.9 to 1.
        share: f64,
    },
    /// The frustum has no end, so that no window of constant size holds it: the map is fitted to the whole scene. A
    /// `scene.visible_depth` with an end gives it one.
    EndlessFrustum,
    /// So far from the world's origin f64 does not tell the parts of a texel apart: nothing to snap to.
    BeyondPrecision,
    /// The map is too small for the border that its filter wants: near its rim the filter reads outside.
    MapTooSmall {
        /// Texels of border on each side.
        border: u32,
        /// Texels that would be wanted.
        wanted: u32,
    },
    /// Texels of this map are no larger in the picture than those of the worst map of the frame: more would not show.
    TexelsEnough {
        /// Texels along a side that it has.
        side: u32,
    },
    /// Texels are worth more in the other maps of the frame.
    TexelsElsewhere {
        /// Texels along a side that it has.
        side: u32,
    },
    /// No receiver sees more than one texel in a pixel.
    TexelsAreLarger {
        /// Most texels over a pixel.
        texels: f64,
    },
    /// Sides that are odd are not halved: a map of 1000 texels has three levels beyond the first, one of 1024 all. What
    /// sees more texels in a pixel shows one in so many.
    SidesAreOdd {
        /// Last level that pixels ask for.
        wanted: u32,
        /// Last level there is.
        halved: u32,
    },
    /// The format of the moments is too coarse for thin shadows: casters nearer to their receivers than this leak.
    FormatLoses {
        /// Standard deviation of depths that the format makes, share of the map's depth range.
        depth: f64,
    },
    /// Sums give means over boxes alone: there is no bell, and there are no mips.
    SumsAreBoxes,
    /// The filter reaches no farther: casters that are farther from their receivers have penumbras as wide as this.
    PenumbraTooWide {
        /// Distance between caster and receiver up to which penumbras are as wide as they should be, world units.
        apart: f64,
    },
    /// No blur is wider than 32 texels, of sums 127: where texels are smallest it is as wide as this.
    BlurTooWide {
        /// Half-width there, world units.
        radius: f64,
    },
    /// Shadows fade over a share of the last of several maps: there is one map for all, or the share is 0.
    NothingToFadeOver,
    /// No two casters lie above one another as the light sees them, nor as near as what is blurred together
    /// (`scene.objects`, each taken for one caster): no light bleeds, and penumbras keep their outer part.
    NothingOverlaps,
    /// The map is fitted to the whole scene, which does not move with the camera: there is nothing to snap.
    AlreadyStill,
    /// The published strength is predicted to be worse than no warp.
    WarpDoesNotPay {
        /// κλ that the method asked for.
        asked: f64,
        /// κλ that is no worse than none.
        limit: f64,
    },
    /// The warp is stronger than its map's texels and the precision of positions allow.
    WarpTooStrong {
        /// κλ that was asked for.
        asked: f64,
        /// κλ that was given.
        limit: f64,
    },
}

/// One line of [`ShadowFrame::left_out`](crate::ShadowFrame::left_out).
/// `Display` gives a sentence for an overlay or a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftOut {
    /// What was left out.
    pub part: Part,
    /// Why.
    pub why: Why,
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Light => write!(f, "light"),
            Self::Frustum => write!(f, "frustum"),
            Self::Split(index) => write!(f, "split {index}"),
            Self::Receivers(index) => write!(f, "view {index}, receivers"),
            Self::Stabilise(index) => write!(f, "view {index}, stabilisation"),
            Self::Window(index) => write!(f, "view {index}, window"),
            Self::Border(index) => write!(f, "view {index}, border"),
            Self::Levels(index) => write!(f, "view {index}, mips"),
            Self::Warp(index) => write!(f, "view {index}, warp"),
            Self::Texels(index) => write!(f, "view {index}, texels"),
            Self::Penumbra(index) => write!(f, "view {index}, penumbra"),
            Self::Blur(index) => write!(f, "view {index}, blur"),
            Self::Fade => write!(f, "fade"),
            Self::Bleeding(index) => write!(f, "view {index}, reduction of bleeding"),
        }
    }
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoReceivers => write!(f, "the scene has no receivers"),
            Self::NoCasters => write!(f, "the scene has no casters"),
            Self::NoReceiversInView { near, far } => write!(f, "no receivers in view in [{near:.4}, {far:.4}]"),
            Self::NothingCastsHere => write!(f, "nothing casts a shadow on the receivers in view"),
            Self::NoDepth => write!(f, "no eye depths between its planes"),
            Self::ServedBy { view } => write!(f, "the map of view {view} serves it as well"),
            Self::MetBy { split } => write!(f, "the map of split {split} is as good there"),
            Self::NoMapLeft => write!(f, "the budget has no map left"),
            Self::OutsideVisibleDepth { near, far } => {
                write!(f, "the visible depth [{near:.4}, {far:.4}] misses the frustum")
            }
            Self::NotVisible { near, far } => write!(f, "not needed outside the visible depth [{near:.4}, {far:.4}]"),
            Self::LitWithoutLookup => write!(f, "outside the shadow of the casters' bounds: lit without a lookup"),
            Self::Degenerate { widened_to } => write!(f, "no extent across the light: widened to {widened_to:.3e}"),
            Self::SceneIsInView { share } => {
                write!(f, "focusing: the view covers {:.0} % of the scene, whose map can be kept", 100.0 * share)
            }
            Self::EndlessFrustum => write!(f, "the frustum has no end: fitted to the scene (give visible_depth)"),
            Self::BeyondPrecision => write!(f, "too far from the world's origin for texels of this size: not snapped"),
            Self::MapTooSmall { border, wanted } => {
                write!(f, "the map is too small: {border} texels, {wanted} wanted by the filter")
            }
            Self::WarpDoesNotPay { asked, limit } => {
                write!(f, "strength {asked:.4} guarded to {limit:.4}: more is predicted to be worse than none")
            }
            Self::WarpTooStrong { asked, limit } => {
                write!(f, "strength {asked:.4} limited to {limit:.4}: beyond that texels outgrow their neighbours")
            }
            Self::TexelsEnough { side } => write!(f, "a side of {side} is as fine in the picture as the worst map"),
            Self::TexelsElsewhere { side } => write!(f, "a side of {side}: the rest is worth more in other maps"),
            Self::TexelsAreLarger { texels } => write!(f, "no pixel sees more than {texels:.2} texels"),
            Self::SidesAreOdd { wanted, halved } => {
                write!(f, "level {halved} instead of {wanted}: sides that are odd are not halved")
            }
            Self::FormatLoses { depth } => {
                write!(f, "the format loses {:.1} % of the depth range: near contacts leak", 100.0 * depth)
            }
            Self::SumsAreBoxes => write!(f, "sums are read in boxes: no bell, no mips"),
            Self::PenumbraTooWide { apart } => {
                write!(f, "no wider than that of casters {apart:.3} from their receivers")
            }
            Self::BlurTooWide { radius } => write!(f, "no wider than {radius:.4} where texels are smallest"),
            Self::NothingToFadeOver => write!(f, "one map for all, or no blend: shadows end at an edge, or not at all"),
            Self::NothingOverlaps => write!(f, "no casters lie above one another: no light bleeds"),
            Self::AlreadyStill => write!(f, "fitted to the scene, which does not move with the camera"),
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.part, self.why)
    }
}
