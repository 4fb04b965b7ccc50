//! The stage of a remix: what a map stores, how it is filtered, and how it is read.
//!
//! # References
//! - Reeves, Salesin & Cook, *Rendering antialiased shadows with depth maps*, 1987: compare, then average.
//! - Donnelly & Lauritzen, *Variance shadow maps*, 2006: average, then compare.
//! - Fernando, *Percentage-closer soft shadows*, 2005: search for casters, then filter as wide as their penumbras.

use crate::encoding::blur::ANTUMBRA_BLUR_MOST;
use crate::encoding::summed::ANTUMBRA_BOX_MOST;
use crate::error::{FitError, within};
use crate::frame::{Pcf, ViewUniforms};
use crate::texel::{MomentKind, Moments, Texel};

/// What a map stores, and how it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Encoding {
    /// Linear light depth, percentage-closer filtered.
    Depth(Pcf),
    /// Moments of linear light depth, blurred before they are read.
    Moments(Prefilter),
    /// Linear light depth, filtered by as much as the light is wide: penumbras of the width that they have, up to the
    /// filter's reach ([`Pcf::Pcss`]).
    Soft {
        /// Angle from one rim of the light to the other as receivers see it, radians, 0 to 0.5. That of the sun is
        /// [`SUN_ANGLE`].
        angle: f32,
    },
}

/// Angular diameter of the sun and of the moon, radians: 32 minutes of arc. [`Pcf::Pcss`] without an angle has it.
pub const SUN_ANGLE: f32 = 0.0093;

/// Largest angle of a light, radians: it would fill a quarter of the sky's width, and penumbras would reach for a
/// quarter of their casters' distance to either side, farther than any border.
const WIDEST_LIGHT: f64 = 0.5;

impl Default for Encoding {
    fn default() -> Self {
        Self::Depth(Pcf::default())
    }
}

/// How moments are filtered and read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prefilter {
    /// Which moments.
    pub moments: Moments,
    /// Half the width of the blur.
    pub radius: Radius,
    /// A bell of the same deviation instead of a box: smoother, 1.4 times as many texels. Of
    /// [sums](crate::MomentFormat::Summed) there are boxes alone, and the report says so.
    pub bell: bool,
    /// Light up to this share is taken for bleeding and removed, 0 (none) to 0.9. Penumbras lose their outer part with
    /// it; so views in which no two of `scene.objects` overlap as the light sees them go without, and get it all at
    /// once when two begin to. An object is taken for one caster there: give what lies above itself, as the leaves of a tree
    /// do, in parts. Without objects, and with more than 32 of them over a view, overlap is assumed.
    pub dark: f32,
}

/// A distance on a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radius {
    /// Texels, 0 to 32, and of [sums](crate::MomentFormat::Summed) 0 to 127: as wide in the picture as texels are.
    Texels(f32),
    /// World units, 0 to 1e9: as wide everywhere, whatever warp and split do. At most as many texels. What receivers
    /// are lifted by for four moments and two exponentials is as many texels everywhere: in strong warps too few near
    /// the eye, where steep ground darkens (`tests/leaks`).
    World(f32),
}

/// Largest radius, world units: far beyond use, far below overflow.
const LARGEST_RADIUS: f64 = 1e9;

/// Most light that may be taken for bleeding: at 1 nothing would be lit.
const MOST_DARK: f64 = 0.9;

/// Standard deviation of what is spread evenly from −1 to 1: 1/√3.
const DEVIATION: f64 = 0.577_350_269_189_625_8;

impl Prefilter {
    /// Moments, averaged over three texels.
    #[must_use]
    pub const fn of(moments: Moments) -> Self {
        Self { moments, radius: Radius::Texels(1.5), bell: false, dark: 0.0 }
    }

    /// Largest half-width of the blur, texels: beyond 32 passes cost more than they are worth, beyond 127 sums do not
    /// hold a box.
    #[must_use]
    pub const fn widest(&self) -> f32 {
        if self.moments.is_summed() { ANTUMBRA_BOX_MOST } else { ANTUMBRA_BLUR_MOST }
    }

    /// Whether it is a bell: of sums there is none.
    pub(crate) const fn is_bell(&self) -> bool {
        self.bell && !self.moments.is_summed()
    }

    /// How far receivers are lifted for the blur, as a share of its radius r, and of a texel of their mip level.
    ///
    /// Of a slanted plane that is averaged, half lies before the receiver at its middle. Depths are then as likely to
    /// either side of their mean, which is the receiver's own, with the deviation σ = r a/√3 where they fall by a over
    /// a texel. What that does:
    /// - Variance, and the mean of an exponential: nothing. At the mean Chebyshev's bound is 1, and exponentials have a
    ///   mean beyond it (Jensen).
    /// - Series: nothing. It is odd about the step, and a half reads lit.
    /// - Four moments: at the mean a share of 5/18 lies before the receiver for sure. None does from one deviation on:
    ///   there the receiver is the lesser node of the two-point rule of Gauss, of which one root goes to infinity. Less
    ///   is acne. The bounds of the range see a little further, and stay below a thousandth.
    /// - Two exponentials: the negative one has its mean before the receiver's, for which ln(sinh(s)/s)/s of the radius
    ///   makes up, s = 2 c⁻ a r. Half of it does up to s = 4: a quarter of the depth range under the blur. Less is acne
    ///   on steep ground, more leaks at contacts.
    ///
    /// What a texel's own extent adds is within the texel that every receiver is lifted by. `tests/leaks` measures it.
    pub(crate) const fn lifted(&self) -> f64 {
        match self.moments.kind() {
            MomentKind::Variance
            | MomentKind::Exponential
            | MomentKind::ExponentialVarianceTwo
            | MomentKind::Convolution => 0.0,
            MomentKind::ExponentialVarianceFour => 0.5,
            MomentKind::Hamburger | MomentKind::Hausdorff => DEVIATION,
        }
    }
}

impl Encoding {
    /// What a texel stores, and how depths are compared: as samplers do for moments, which are not.
    pub(crate) const fn key(&self) -> (Texel, Pcf) {
        match self {
            Self::Depth(filter) => (Texel::Depth, *filter),
            Self::Moments(prefilter) => (Texel::Moments(prefilter.moments), Pcf::Hardware2x2),
            Self::Soft { .. } => (Texel::Depth, Pcf::Pcss),
        }
    }

    /// Level of the mip chain up to which a view's map is made.
    pub(crate) const fn levels(&self, view: &ViewUniforms) -> f32 {
        match self {
            Self::Moments(_) => view.moments[1],
            Self::Depth(_) | Self::Soft { .. } => 0.0,
        }
    }

    /// Angular diameter of the light, radians, for filters that need it.
    pub(crate) const fn angle(&self) -> Option<f32> {
        match self {
            Self::Soft { angle } => Some(*angle),
            Self::Depth(Pcf::Pcss) => Some(SUN_ANGLE),
            Self::Depth(_) | Self::Moments(_) => None,
        }
    }

    /// Checks its numbers.
    pub(crate) fn validate(&self) -> Result<(), FitError> {
        let prefilter = match self {
            Self::Depth(_) => return Ok(()),
            Self::Soft { angle } => return within("encoding.angle", *angle, [0.0, WIDEST_LIGHT], "0 to 0.5"),
            Self::Moments(prefilter) => prefilter,
        };
        within("encoding.dark", prefilter.dark, [0.0, MOST_DARK], "0 to 0.9")?;
        match prefilter.radius {
            Radius::Texels(radius) => {
                let legal = if prefilter.moments.is_summed() { "0 to 127" } else { "0 to 32" };
                within("encoding.radius", radius, [0.0, f64::from(prefilter.widest())], legal)
            }
            Radius::World(radius) => within("encoding.radius", radius, [0.0, LARGEST_RADIUS], "0 to 1e9"),
        }
    }
}
