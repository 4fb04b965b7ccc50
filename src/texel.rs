//! What a texel of the map that receivers read stores: a depth, or moments of depths that are averaged first.

use bytemuck::{Pod, Zeroable};

/// What is stored per texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Texel {
    /// The nearest depth, compared when it is read ([`Pcf`](crate::Pcf)).
    #[default]
    Depth,
    /// Numbers whose mean says how much light arrives: maps are blurred once, and read with one sample.
    Moments(Moments),
}

/// Which moments, in which format, and how they are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Moments {
    kind: MomentKind,
    format: MomentFormat,
    /// Whether samplers interpolate the format; otherwise the shader does, from four texels.
    pub linear: bool,
    /// Whether far texels are read from smaller copies of the map. Maps that share a layer ([`Share`](crate::Share))
    /// are read from those in which they are whole texels: all of them, where sides are powers of two of 512 or more.
    /// [Sums](MomentFormat::Summed) have none, and the report says so.
    pub mips: bool,
}

/// Which moments of depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MomentKind {
    /// Depth and its square ([`encoding::variance`](crate::encoding::variance)): light bleeds where casters overlap.
    Variance,
    /// An exponential of depth ([`encoding::exponential`](crate::encoding::exponential)): light leaks at contacts.
    Exponential,
    /// Variance of one exponential: bleeds less, leaks at contacts.
    ExponentialVarianceTwo,
    /// Variance of two exponentials: bleeds less.
    ExponentialVarianceFour,
    /// A Fourier series of 8 terms ([`encoding::convolution`](crate::encoding::convolution)): rings.
    Convolution,
    /// Four moments, for depths anywhere ([`encoding::moments`](crate::encoding::moments)).
    Hamburger,
    /// Four moments, for depths within the map: darker, a little dearer.
    Hausdorff,
}

/// How numbers are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MomentFormat {
    /// 32 bits, floating: every adapter draws it; samplers interpolate it with a feature only.
    #[default]
    Float32,
    /// 16 bits, floating: every adapter draws and interpolates it.
    Float16,
    /// 16 bits, 0 to 1: needs a feature.
    Unorm16,
    /// 8 bits, 0 to 1: every adapter draws and interpolates it.
    Unorm8,
    /// 16 bits, 0 to 1, summed over all texels of the view before it in u and in v, in integers of 32 bits that wrap
    /// around: a summed-area table. Every receiver reads the mean over a box of its own width, up to
    /// [254 texels](crate::Prefilter::widest), from 16 loads; sums of that many are exact whatever the map's size is.
    /// Boxes alone: no bell, no mips. Every adapter draws it.
    Summed,
}

/// What the filter has to know of a view. The layout equals `AntumbraBlur` in the shader, member by member.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct BlurUniforms {
    /// The view's texels in its layer: first x and y, side; and the layer's side.
    pub tile: [u32; 4],
    /// World steps from texel to texel: `t_u` = w² (V − v W), `t_v` = w² (u W − U). This is U, x to z; the last member
    /// is 0.
    pub across_u: [f32; 4],
    /// V of those steps.
    pub across_v: [f32; 4],
    /// W of those steps.
    pub across_w: [f32; 4],
    /// 1/w at texture coordinates: dot(row, (u, v, 1)); the last member is 0.
    pub inverse_w: [f32; 4],
    /// Half the width of the box: world units where it is not negative, else texels, negated.
    pub radius: f32,
    /// 1: a bell instead of a box.
    pub bell: u32,
    /// First term of a series, for what is stored as one.
    pub first_term: u32,
    /// Texels between those that a pass adds, for what is summed: 1, and [`SUMMED_TEXELS`] times as many with every
    /// further pass along an axis.
    pub stride: u32,
}

/// Terms of the series of [`MomentKind::Convolution`]: four would blur shadows over a quarter of the depth range, 16
/// take 32 bytes a texel.
pub const CONVOLUTION_TERMS: u32 = 8;

/// Texels that a pass adds to make [sums](MomentFormat::Summed): eight make sums of 4096 in four passes. Two would take
/// twelve, sixteen would save one and load as many again.
pub const SUMMED_TEXELS: u32 = 8;

/// Last level of a mip chain: tiles of a layer stay apart in it as long as they are 64 texels wide.
const LAST_LEVEL: u32 = 6;

impl MomentKind {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Variance,
        Self::Exponential,
        Self::ExponentialVarianceTwo,
        Self::ExponentialVarianceFour,
        Self::Convolution,
        Self::Hamburger,
        Self::Hausdorff,
    ];

    /// Formats that hold them, the most exact one first.
    #[must_use]
    pub const fn formats(self) -> &'static [MomentFormat] {
        use MomentFormat::{Float16, Float32, Summed, Unorm8, Unorm16};
        match self {
            Self::Variance => &[Float32, Unorm16, Float16, Summed],
            Self::Exponential | Self::ExponentialVarianceTwo | Self::ExponentialVarianceFour => &[Float32, Float16],
            Self::Convolution => &[Unorm8],
            Self::Hamburger | Self::Hausdorff => &[Float32, Unorm16, Summed],
        }
    }

    /// Numbers of a texel.
    #[must_use]
    pub const fn channels(self) -> u32 {
        match self {
            Self::Exponential => 1,
            Self::Variance | Self::ExponentialVarianceTwo => 2,
            Self::ExponentialVarianceFour | Self::Hamburger | Self::Hausdorff => 4,
            Self::Convolution => 2 * CONVOLUTION_TERMS,
        }
    }

    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Variance => "variance",
            Self::Exponential => "exponential",
            Self::ExponentialVarianceTwo => "exponential variance 2",
            Self::ExponentialVarianceFour => "exponential variance 4",
            Self::Convolution => "convolution",
            Self::Hamburger => "four moments, Hamburger",
            Self::Hausdorff => "four moments, Hausdorff",
        }
    }
}

impl MomentFormat {
    /// Bits of a number.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::Float32 | Self::Summed => 32,
            Self::Float16 | Self::Unorm16 => 16,
            Self::Unorm8 => 8,
        }
    }

    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float32 => "f32",
            Self::Float16 => "f16",
            Self::Unorm16 => "unorm16",
            Self::Unorm8 => "unorm8",
            Self::Summed => "summed",
        }
    }

    /// Whether numbers are packed as 16 bits keep them best.
    pub(crate) const fn is_packed(self) -> bool {
        matches!(self, Self::Unorm16 | Self::Summed)
    }

    /// Whether every adapter interpolates it.
    const fn is_linear(self) -> bool {
        !matches!(self, Self::Float32 | Self::Summed)
    }
}

impl Moments {
    /// Moments in a format; in the most exact one that holds them where that one does not. Without mips, and read by
    /// four loads where not every adapter interpolates the format.
    #[must_use]
    pub fn new(kind: MomentKind, format: MomentFormat) -> Self {
        let formats = kind.formats();
        let format = if formats.contains(&format) { format } else { formats[0] };
        Self { kind, format, linear: format.is_linear(), mips: false }
    }

    /// The same, interpolated by samplers or by the shader, with or without mips. No sampler interpolates sums.
    #[must_use]
    pub const fn read(self, linear: bool, mips: bool) -> Self {
        Self { linear: linear && !self.is_summed(), mips, ..self }
    }

    /// Every kind in every format that holds it, each read in every way there is.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_kind = |kind: MomentKind| kind.formats().iter().map(move |format| Self::new(kind, *format));
        MomentKind::ALL.into_iter().flat_map(of_kind).flat_map(|moments| {
            let linear = match moments.format {
                MomentFormat::Float32 => &[false, true][..],
                MomentFormat::Summed => &[false],
                _ => &[true],
            };
            let mips = if moments.is_summed() { &[false][..] } else { &[false, true] };
            linear.iter().flat_map(move |linear| mips.iter().map(move |mips| moments.read(*linear, *mips)))
        })
    }

    /// Last level of the mip chain of a map with this side: a texel of level 6 is 64 texels wide, which is as blurred
    /// as pictures ask for.
    #[must_use]
    pub const fn last_level(self, side: u32) -> u32 {
        let levels = if side > 1 { side.ilog2() } else { 0 };
        if !self.mips || self.is_summed() {
            0
        } else if levels < LAST_LEVEL {
            levels
        } else {
            LAST_LEVEL
        }
    }

    /// Which moments.
    #[must_use]
    pub const fn kind(self) -> MomentKind {
        self.kind
    }

    /// How they are kept.
    #[must_use]
    pub const fn format(self) -> MomentFormat {
        self.format
    }

    /// Whether texels hold sums.
    #[must_use]
    pub const fn is_summed(self) -> bool {
        matches!(self.format, MomentFormat::Summed)
    }

    /// Bytes of a texel of the map that is read.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        self.kind.channels() * self.format.bits() / 8
    }

    /// Array layers that a map takes: a series has more numbers than a texel.
    #[must_use]
    pub const fn layers(self) -> u32 {
        self.kind.channels().div_ceil(4)
    }

    /// c⁺ and c⁻ of exponential variance: just below half the logarithm of the largest number (5.545, 44.36). For 32
    /// bits the far side keeps 40, which is as much for a sum of 100 texels; near a contact more than 8 tells rounding
    /// apart from depth.
    #[must_use]
    pub const fn exponents(self) -> [f32; 2] {
        match self.format {
            MomentFormat::Float32 => [40.0, 8.0],
            _ => [5.54, 5.54],
        }
    }

    /// c of an exponential: light leaks over 1/c of the depth range behind a caster. With 16 bits a step of depth is
    /// 1/2048, and more than 40 shows it.
    #[must_use]
    pub const fn exponent(self) -> f32 {
        match self.format {
            MomentFormat::Float32 => 80.0,
            _ => 40.0,
        }
    }

    /// What rounding takes from the variance of centred depths: MATH.md section 7, measured; a quarter of what is
    /// stated there for 32 bits, because depths are centred.
    #[must_use]
    pub const fn variance_loss(self) -> f32 {
        match self.format {
            MomentFormat::Float32 => 5e-7,
            MomentFormat::Unorm16 => 4e-5,
            // Each depth is rounded once, by half a step of 1/65535: ¼ of that of the square, and 2 · ½ of depth.
            MomentFormat::Summed => 1.1e-5,
            MomentFormat::Float16 | MomentFormat::Unorm8 => 1e-3,
        }
    }

    /// Standard deviation of depth that rounding makes of bent depths, share of the range: for 16 bits steps of 1/2048
    /// of a square, over twice the exponent.
    #[must_use]
    pub const fn blur(self) -> f32 {
        match self.format {
            MomentFormat::Float32 => 1e-4,
            _ => 4.4e-3,
        }
    }

    /// Share of a spread distribution that keeps four moments possible: MATH.md section 7.
    #[must_use]
    pub const fn moment_bias(self) -> f32 {
        match self.format {
            MomentFormat::Float32 => 1e-6,
            _ => 6e-5,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_legal_and_bytes_are_theirs() {
        for kind in MomentKind::ALL {
            for format in [MomentFormat::Float32, MomentFormat::Float16, MomentFormat::Unorm16, MomentFormat::Unorm8] {
                assert!(kind.formats().contains(&Moments::new(kind, format).format()));
            }
        }
        let bytes = |kind, format| Moments::new(kind, format).bytes();
        assert_eq!(bytes(MomentKind::Variance, MomentFormat::Float32), 8);
        assert_eq!(bytes(MomentKind::Hamburger, MomentFormat::Unorm16), 8);
        assert_eq!(bytes(MomentKind::Convolution, MomentFormat::Float32), 16);
        assert_eq!(Moments::all().count(), 43);
    }

    /// Squares of bent depths, and sums of many, stay below the largest number.
    #[test]
    fn exponents_do_not_overflow() {
        for moments in Moments::all() {
            let largest = if moments.format == MomentFormat::Float32 { f64::from(f32::MAX) } else { 65_504.0 };
            for exponent in moments.exponents() {
                assert!((2.0 * f64::from(exponent)).exp() < largest);
            }
        }
    }
}
