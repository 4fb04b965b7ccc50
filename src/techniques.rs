//! Techniques by name, with the paper each is from.

use crate::encoding::stage::{Encoding, Prefilter};
use crate::frame::{Pcf, Select};
use crate::grazing::Grazing;
use crate::remix::Remix;
use crate::split::{DepthSplits, Scheme, Split};
use crate::texel::{MomentFormat, MomentKind, Moments};
use crate::warp::{Focus, Warp};

/// Makes a remix with its default options.
pub type Maker = fn() -> Remix;

/// A function for each technique, and the list of them all: `function "name" { stages that are not the default }`,
/// behind its documentation.
macro_rules! named {
    ($($(#[$doc:meta])+ $function:ident $name:literal { $($stage:ident: $choice:expr),+ })+) => {
        $(
            $(#[$doc])+
            #[must_use]
            pub fn $function() -> Remix {
                Remix { $($stage: $choice,)+ ..Remix::default() }
            }
        )+

        /// Every named technique, in the order in which reports list them.
        pub const NAMED: &[(&str, Maker)] = &[$(($name, $function)),+];
    };
}

/// The splits of the paper.
const PSSM: DepthSplits = DepthSplits {
    maps: 3,
    scheme: Scheme::Practical { lambda: 0.5, offset: 0.0 },
    select: Select::Depth,
    enough: 0.0,
    ..DepthSplits::DEFAULT
};

/// Moments of 32 bits with mips, averaged over three texels.
fn moments(kind: MomentKind) -> Encoding {
    let moments = Moments::new(kind, MomentFormat::Float32);
    Encoding::Moments(Prefilter::of(moments.read(moments.linear, true)))
}

named! {
    /// The standard shadow map: one uniform map over the whole scene. Its map does not depend on the camera.
    ///
    /// L. Williams, *Casting curved shadows on curved surfaces*, SIGGRAPH 1978.
    ssm "ssm" { warp: Warp::Uniform }

    /// The focused shadow map: one uniform map over what is in view.
    ///
    /// S. Brabec, T. Annen, H.-P. Seidel, *Practical shadow mapping*, Journal of Graphics Tools 7(4), 2002.
    fsm "fsm" { warp: Warp::Focused }

    /// The perspective shadow map: the light's view of the camera's post-perspective space.
    ///
    /// M. Stamminger, G. Drettakis, *Perspective shadow maps*, SIGGRAPH 2002.
    psm "psm" { warp: Warp::Perspective { pull_back: 0.0 } }

    /// The trapezoidal shadow map: 80 % of the map for the first part of what is in view.
    ///
    /// T. Martin, T.-S. Tan, *Anti-aliasing and continuity with trapezoidal shadow maps*, EGSR 2004.
    tsm "tsm" { warp: Warp::Trapezoidal { focus: Focus::default() } }

    /// The light-space perspective shadow map: perspective errors are equal at both ends of what is in view.
    ///
    /// M. Wimmer, D. Scherzer, W. Purgathofer, *Light space perspective shadow maps*, EGSR 2004.
    lispsm "lispsm" { warp: Warp::LightSpacePerspective }

    /// The warp with the least worst footprint.
    ///
    /// After B. Lloyd et al., *Logarithmic perspective shadow maps*, ACM Transactions on Graphics 27(4), 2008, whose
    /// bound it minimises.
    minimax "minimax" { warp: Warp::Minimax }

    /// The warp with the least predicted picture error: this crate's own, see [`Warp::LeastError`].
    least_error "least-error" { warp: Warp::LeastError }

    /// Parallel-split shadow maps: three maps, practical splits with λ = ½, no warp.
    ///
    /// F. Zhang, H. Sun, L. Xu, L. K. Lun, *Parallel-split shadow maps for large-scale virtual environments*, VRCIA
    /// 2006.
    pssm "pssm" { split: Split::Depth(PSSM), warp: Warp::Focused }

    /// Cascades: four maps where they pay most, each with the warp that pays there. This crate's own.
    cascades "cascades" { split: Split::Depth(DepthSplits::DEFAULT) }

    /// The variance shadow map, focused: two moments, blurred.
    ///
    /// W. Donnelly, A. Lauritzen, *Variance shadow maps*, I3D 2006.
    vsm "vsm" { warp: Warp::Focused, encoding: moments(MomentKind::Variance) }

    /// The exponential shadow map, focused: the mean of exponentials of depth.
    ///
    /// T. Annen, T. Mertens, H.-P. Seidel, E. Flerackers, J. Kautz, *Exponential shadow maps*, Graphics Interface 2008.
    esm "esm" { warp: Warp::Focused, encoding: moments(MomentKind::Exponential) }

    /// The convolution shadow map, focused: a Fourier series of 8 terms.
    ///
    /// T. Annen, T. Mertens, P. Bekaert, H.-P. Seidel, J. Kautz, *Convolution shadow maps*, EGSR 2007.
    convolution "convolution" { warp: Warp::Focused, encoding: moments(MomentKind::Convolution) }

    /// The exponential variance shadow map, focused: variance of two exponentials.
    ///
    /// A. Lauritzen, M. `McCool`, *Layered variance shadow maps*, Graphics Interface 2008.
    evsm "evsm" { warp: Warp::Focused, encoding: moments(MomentKind::ExponentialVarianceFour) }

    /// The same with the first exponential alone.
    evsm_two "evsm-two" { warp: Warp::Focused, encoding: moments(MomentKind::ExponentialVarianceTwo) }

    /// The moment shadow map, focused: four moments, Hamburger.
    ///
    /// C. Peters, R. Klein, *Moment shadow mapping*, I3D 2015.
    msm "msm" { warp: Warp::Focused, encoding: moments(MomentKind::Hamburger) }

    /// The same for depths known to be within the map, Hausdorff.
    msm_hausdorff "msm-hausdorff" { warp: Warp::Focused, encoding: moments(MomentKind::Hausdorff) }

    /// The Shadow Mapping Remix Approach: practical splits, a trapezoid for each, variance, and ½ where
    /// the light grazes a surface, as the thesis has it. Its trapezoids are not guarded. Errata: depths are the light's
    /// (TH-7), planes move between the ends alone (TH-10), and Chebyshev's bound is one of light (TH-13).
    ///
    /// J. Abrantes de Oliveira, *Analysis and proposal of a shadow mapping remix approach*, Universidade do Minho,
    /// chapter 4.
    smra "smra" {
        split: Split::Depth(PSSM),
        warp: Warp::Trapezoidal { focus: Focus::default() },
        encoding: moments(MomentKind::Variance),
        guard: false,
        grazing: Grazing::Printed
    }

    /// The same remix of what measurements justify: splits of equal predicted error, the finest map that holds a
    /// receiver, no warps, which beside such splits gain 1 to 2 % of error for half as much fit again and a fragment
    /// stage for casters, and four comparisons over the part of the map that a pixel covers instead of moments, which
    /// leak in foliage. This crate's own; docs/THESIS.md has each step.
    smra_plus "smra-plus" {
        split: Split::Depth(DepthSplits::DEFAULT),
        warp: Warp::Focused,
        encoding: Encoding::Depth(Pcf::Pixel)
    }
}

/// The technique of that name, if there is one.
#[must_use]
pub fn by_name(name: &str) -> Option<Remix> {
    NAMED.iter().find(|(known, _)| *known == name).map(|(_, technique)| technique())
}
