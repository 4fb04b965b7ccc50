//! The fragments of maps of moments: what is stored, how it is averaged, and how it is read.

use std::borrow::Cow;

use arrayvec::ArrayVec;

use crate::frame::MapShape;
use crate::texel::{CONVOLUTION_TERMS, MomentFormat, MomentKind, Moments};

/// Most fragments that read a map of moments.
const MAX_READ: usize = 12;

/// What finds out how much light arrives, from what is stored where a receiver is looked up; `arrayed`: whether maps
/// are layers of an array.
pub(super) fn read(moments: Moments, arrayed: bool) -> ArrayVec<Cow<'static, str>, MAX_READ> {
    let mut fragments = ArrayVec::new();
    fragments.push(read_numbers(moments).into());
    let mut push = |text: &'static str| fragments.push(Cow::Borrowed(text));
    lit(moments).into_iter().for_each(&mut push);
    push(include_str!("../../shaders/darkened.wgsl"));
    // What is stored at a place.
    if moments.is_summed() {
        push(if arrayed {
            include_str!("../../shaders/summed_many.wgsl")
        } else {
            include_str!("../../shaders/summed_one.wgsl")
        });
        push(include_str!("../../shaders/summed.wgsl"));
        push(include_str!("../../shaders/read_moments.wgsl"));
        return fragments;
    }
    if arrayed {
        push(include_str!("../../shaders/rim.wgsl"));
    }
    push(match (moments.linear, arrayed) {
        (true, false) => include_str!("../../shaders/sample_linear_one.wgsl"),
        (true, true) => include_str!("../../shaders/sample_linear_many.wgsl"),
        (false, false) => include_str!("../../shaders/sample_loads_one.wgsl"),
        (false, true) => include_str!("../../shaders/sample_loads_many.wgsl"),
    });
    match (moments.linear, moments.mips) {
        (true, _) => {}
        (false, false) => push(include_str!("../../shaders/sample_loads_level.wgsl")),
        (false, true) => push(include_str!("../../shaders/sample_loads_levels.wgsl")),
    }
    // What it says.
    push(match moments.kind() {
        MomentKind::Convolution => include_str!("../../shaders/read_convolution.wgsl"),
        _ => include_str!("../../shaders/read_moments.wgsl"),
    });
    fragments
}

/// What is known of a receiver; `arrayed`: whether maps are layers of an array.
pub(super) fn map(moments: Moments, arrayed: bool) -> &'static str {
    match (moments.is_summed(), arrayed) {
        (false, false) => include_str!("../../shaders/map_one_moments.wgsl"),
        (false, true) => include_str!("../../shaders/map_many_moments.wgsl"),
        (true, false) => include_str!("../../shaders/map_one_summed.wgsl"),
        (true, true) => include_str!("../../shaders/map_many_summed.wgsl"),
    }
}

/// Where a receiver is looked up, its bias applied: in which level, or how wide.
pub(super) fn look(moments: Moments, shape: MapShape) -> [&'static str; 2] {
    let level = match (moments.is_summed(), moments.mips) {
        (true, _) => include_str!("../../shaders/half_widths.wgsl"),
        (false, true) => include_str!("../../shaders/level_many.wgsl"),
        (false, false) => include_str!("../../shaders/level_one.wgsl"),
    };
    let look = match (moments.is_summed(), shape) {
        (false, MapShape::Affine) => include_str!("../../shaders/look_affine_moments.wgsl"),
        (false, _) => include_str!("../../shaders/look_projective_moments.wgsl"),
        (true, MapShape::Affine) => include_str!("../../shaders/look_affine_summed.wgsl"),
        (true, _) => include_str!("../../shaders/look_projective_summed.wgsl"),
    };
    [level, look]
}

/// Share of the light by what is stored.
fn lit(moments: Moments) -> ArrayVec<&'static str, 5> {
    const CHEBYSHEV: &str = include_str!("../../shaders/chebyshev.wgsl");
    const BENT: &str = include_str!("../../shaders/exponential_variance.wgsl");
    let mut fragments = ArrayVec::new();
    let mut add = |texts: &[&'static str]| fragments.extend(texts.iter().copied());
    match moments.kind() {
        MomentKind::Variance => {
            add(&[CHEBYSHEV, include_str!("../../shaders/variance.wgsl")]);
            add(two(moments));
        }
        MomentKind::Exponential => {
            add(&[include_str!("../../shaders/exponential.wgsl"), include_str!("../../shaders/read_exponential.wgsl")]);
        }
        MomentKind::ExponentialVarianceTwo => add(&[
            CHEBYSHEV,
            BENT,
            include_str!("../../shaders/exponential_variance_two.wgsl"),
            include_str!("../../shaders/read_exponential_variance_two.wgsl"),
        ]),
        MomentKind::ExponentialVarianceFour => add(&[
            CHEBYSHEV,
            BENT,
            include_str!("../../shaders/exponential_variance_four.wgsl"),
            include_str!("../../shaders/read_exponential_variance.wgsl"),
        ]),
        MomentKind::Convolution => {
            add(&[include_str!("../../shaders/convolution.wgsl"), include_str!("../../shaders/convolution_read.wgsl")]);
        }
        MomentKind::Hamburger | MomentKind::Hausdorff => {
            add(&[include_str!("../../shaders/moments.wgsl"), include_str!("../../shaders/moments_hamburger.wgsl")]);
            add(four(moments));
        }
    }
    fragments
}

/// How two moments are unpacked and read.
fn two(moments: Moments) -> &'static [&'static str] {
    match moments.format() {
        MomentFormat::Unorm16 | MomentFormat::Summed => &[
            include_str!("../../shaders/variance_unpacked.wgsl"),
            include_str!("../../shaders/read_variance_sixteen.wgsl"),
        ],
        _ => &[include_str!("../../shaders/read_variance.wgsl")],
    }
}

/// What four moments need beyond roots and least shares.
fn four(moments: Moments) -> &'static [&'static str] {
    const UNPACKED: &str = include_str!("../../shaders/moments_unpacked.wgsl");
    const WITHIN: &str = include_str!("../../shaders/moments_hausdorff.wgsl");
    match (moments.kind(), moments.format()) {
        (MomentKind::Hausdorff, MomentFormat::Unorm16 | MomentFormat::Summed) => {
            &[WITHIN, UNPACKED, include_str!("../../shaders/read_hausdorff_sixteen.wgsl")]
        }
        (MomentKind::Hausdorff, _) => &[WITHIN, include_str!("../../shaders/read_hausdorff.wgsl")],
        (_, MomentFormat::Unorm16 | MomentFormat::Summed) => &[
            include_str!("../../shaders/moments_lit.wgsl"),
            UNPACKED,
            include_str!("../../shaders/read_hamburger_sixteen.wgsl"),
        ],
        _ => &[include_str!("../../shaders/moments_lit.wgsl"), include_str!("../../shaders/read_hamburger.wgsl")],
    }
}

/// The numbers that depend on the format and are read, as constants.
fn read_numbers(moments: Moments) -> String {
    match moments.kind() {
        MomentKind::Variance => format!("const ANTUMBRA_VARIANCE_LOSS: f32 = {:e};", moments.variance_loss()),
        MomentKind::Exponential => stored_numbers(moments),
        MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour => {
            format!("{}\nconst ANTUMBRA_BLUR: f32 = {:e};", stored_numbers(moments), moments.blur())
        }
        MomentKind::Convolution => format!("const ANTUMBRA_TERMS: u32 = {CONVOLUTION_TERMS}u;"),
        MomentKind::Hamburger | MomentKind::Hausdorff => {
            format!("const ANTUMBRA_MOMENTS_MIXED: f32 = {:e};", moments.moment_bias())
        }
    }
}

/// The numbers that depend on the format and are stored with, as constants.
fn stored_numbers(moments: Moments) -> String {
    match moments.kind() {
        MomentKind::Exponential => format!("const ANTUMBRA_EXPONENT: f32 = {:e};", moments.exponent()),
        MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour => {
            let [far, near] = moments.exponents();
            format!("const ANTUMBRA_EXPONENTS = vec2f({far:e}, {near:e});")
        }
        _ => String::new(),
    }
}

/// What is stored of a depth.
fn stored(moments: Moments) -> &'static [&'static str] {
    match (moments.kind(), moments.format()) {
        (MomentKind::Variance, MomentFormat::Unorm16 | MomentFormat::Summed) => &[
            include_str!("../../shaders/variance_stored.wgsl"),
            include_str!("../../shaders/variance_packed.wgsl"),
            include_str!("../../shaders/store_variance_sixteen.wgsl"),
        ],
        (MomentKind::Variance, _) => {
            &[include_str!("../../shaders/variance_stored.wgsl"), include_str!("../../shaders/store_variance.wgsl")]
        }
        (MomentKind::Exponential, _) => &[
            include_str!("../../shaders/exponential_stored.wgsl"),
            include_str!("../../shaders/exponential_mean.wgsl"),
            include_str!("../../shaders/store_exponential.wgsl"),
        ],
        (MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour, _) => &[
            include_str!("../../shaders/exponential_variance.wgsl"),
            include_str!("../../shaders/exponential_variance_stored.wgsl"),
            include_str!("../../shaders/store_exponential_variance.wgsl"),
        ],
        (MomentKind::Convolution, _) => {
            &[include_str!("../../shaders/convolution.wgsl"), include_str!("../../shaders/store_convolution.wgsl")]
        }
        (MomentKind::Hamburger | MomentKind::Hausdorff, MomentFormat::Unorm16 | MomentFormat::Summed) => &[
            include_str!("../../shaders/moments_stored.wgsl"),
            include_str!("../../shaders/moments_packed.wgsl"),
            include_str!("../../shaders/store_moments_sixteen.wgsl"),
        ],
        (MomentKind::Hamburger | MomentKind::Hausdorff, _) => {
            &[include_str!("../../shaders/moments_stored.wgsl"), include_str!("../../shaders/store_moments.wgsl")]
        }
    }
}

/// The whole text of the passes that filter a map of depths into one of moments: entry points and bindings in group 0.
#[must_use]
pub(super) fn prefilter(moments: Moments) -> String {
    let mean = match moments.kind() {
        MomentKind::Exponential => include_str!("../../shaders/mean_exponential.wgsl"),
        _ => include_str!("../../shaders/mean.wgsl"),
    };
    let passes = if moments.is_summed() {
        &[include_str!("../../shaders/prefilter_summed.wgsl")][..]
    } else {
        &[mean, include_str!("../../shaders/prefilter.wgsl")]
    };
    let mut text = stored_numbers(moments);
    let blur = core::iter::once(include_str!("../../shaders/blur.wgsl"));
    for fragment in blur.chain(stored(moments).iter().chain(passes).copied()) {
        text.push('\n');
        text.push_str(fragment);
    }
    text
}
