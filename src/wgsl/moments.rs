//! The fragments of maps of moments: what is stored, how it is averaged, and how it is read.

use std::borrow::Cow;

use arrayvec::ArrayVec;

use crate::texel::{MomentFormat, MomentKind, Moments};

/// Most fragments that define what is stored.
const MAX_STORED: usize = 5;

/// What is stored of a depth, and the numbers that depend on its format.
fn stored(moments: Moments) -> ArrayVec<Cow<'static, str>, MAX_STORED> {
    const CHEBYSHEV: &str = include_str!("../../shaders/chebyshev.wgsl");
    let mut fragments = ArrayVec::new();
    let mut push = |text: &'static str| fragments.push(Cow::Borrowed(text));
    match moments.kind() {
        MomentKind::Variance => {
            push(CHEBYSHEV);
            push(include_str!("../../shaders/variance.wgsl"));
            if moments.format() == MomentFormat::Unorm16 {
                push(include_str!("../../shaders/variance_sixteen.wgsl"));
            }
        }
        MomentKind::Exponential => push(include_str!("../../shaders/exponential.wgsl")),
        MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour => {
            push(CHEBYSHEV);
            push(include_str!("../../shaders/exponential_variance.wgsl"));
        }
        MomentKind::Convolution => push(include_str!("../../shaders/convolution.wgsl")),
        MomentKind::Hamburger | MomentKind::Hausdorff => {
            push(include_str!("../../shaders/moments.wgsl"));
            push(include_str!("../../shaders/moments_hamburger.wgsl"));
            if moments.kind() == MomentKind::Hausdorff {
                push(include_str!("../../shaders/moments_hausdorff.wgsl"));
            }
            if moments.format() == MomentFormat::Unorm16 {
                push(include_str!("../../shaders/moments_sixteen.wgsl"));
            }
        }
    }
    fragments.push(numbers(moments).into());
    fragments
}

/// The numbers that depend on the format, as constants.
fn numbers(moments: Moments) -> String {
    let [far, near] = moments.exponents();
    match moments.kind() {
        MomentKind::Variance => format!("const ANTUMBRA_VARIANCE_LOSS: f32 = {:e};", moments.variance_loss()),
        MomentKind::Exponential => format!("const ANTUMBRA_EXPONENT: f32 = {:e};", moments.exponent()),
        MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour => format!(
            "const ANTUMBRA_EXPONENTS = vec2f({far:e}, {near:e});\nconst ANTUMBRA_BLUR: f32 = {:e};",
            moments.blur()
        ),
        MomentKind::Convolution => format!("const ANTUMBRA_TERMS: u32 = {}u;", crate::texel::CONVOLUTION_TERMS),
        MomentKind::Hamburger | MomentKind::Hausdorff => {
            format!("const ANTUMBRA_MOMENTS_MIXED: f32 = {:e};", moments.moment_bias())
        }
    }
}

/// Most fragments that read a map of moments.
const MAX_READ: usize = MAX_STORED + 6;

/// What finds out how much light arrives, from what is stored where a receiver is looked up; `arrayed`: whether maps are
/// layers of an array.
pub(super) fn read(moments: Moments, arrayed: bool) -> ArrayVec<Cow<'static, str>, MAX_READ> {
    let mut fragments: ArrayVec<_, MAX_READ> = stored(moments).into_iter().collect();
    let mut push = |text: &'static str| fragments.push(Cow::Borrowed(text));
    push(include_str!("../../shaders/darkened.wgsl"));
    // What is stored at a place.
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
    let sixteen = moments.format() == MomentFormat::Unorm16;
    match moments.kind() {
        MomentKind::Variance if sixteen => push(include_str!("../../shaders/read_variance_sixteen.wgsl")),
        MomentKind::Variance => push(include_str!("../../shaders/read_variance.wgsl")),
        MomentKind::Exponential => push(include_str!("../../shaders/read_exponential.wgsl")),
        MomentKind::ExponentialVarianceTwo => push(include_str!("../../shaders/read_exponential_variance_two.wgsl")),
        MomentKind::ExponentialVarianceFour => push(include_str!("../../shaders/read_exponential_variance.wgsl")),
        MomentKind::Convolution => {}
        MomentKind::Hamburger if sixteen => push(include_str!("../../shaders/read_hamburger_sixteen.wgsl")),
        MomentKind::Hamburger => push(include_str!("../../shaders/read_hamburger.wgsl")),
        MomentKind::Hausdorff if sixteen => push(include_str!("../../shaders/read_hausdorff_sixteen.wgsl")),
        MomentKind::Hausdorff => push(include_str!("../../shaders/read_hausdorff.wgsl")),
    }
    push(match moments.kind() {
        MomentKind::Convolution => include_str!("../../shaders/read_convolution.wgsl"),
        _ => include_str!("../../shaders/read_moments.wgsl"),
    });
    fragments
}

/// The whole text of the passes that filter a map of depths into one of moments: entry points and bindings in group 0.
#[must_use]
pub(super) fn prefilter(moments: Moments) -> String {
    let store = match (moments.kind(), moments.format()) {
        (MomentKind::Variance, MomentFormat::Unorm16) => include_str!("../../shaders/store_variance_sixteen.wgsl"),
        (MomentKind::Variance, _) => include_str!("../../shaders/store_variance.wgsl"),
        (MomentKind::Exponential, _) => include_str!("../../shaders/store_exponential.wgsl"),
        (MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour, _) => {
            include_str!("../../shaders/store_exponential_variance.wgsl")
        }
        (MomentKind::Convolution, _) => include_str!("../../shaders/store_convolution.wgsl"),
        (_, MomentFormat::Unorm16) => include_str!("../../shaders/store_moments_sixteen.wgsl"),
        (MomentKind::Hamburger | MomentKind::Hausdorff, _) => include_str!("../../shaders/store_moments.wgsl"),
    };
    let mean = match moments.kind() {
        MomentKind::Exponential => include_str!("../../shaders/mean_exponential.wgsl"),
        _ => include_str!("../../shaders/mean.wgsl"),
    };
    let mut text = String::new();
    let rest = [include_str!("../../shaders/blur.wgsl"), store, mean, include_str!("../../shaders/prefilter.wgsl")];
    for fragment in stored(moments).iter().map(AsRef::as_ref).chain(rest) {
        text.push_str(fragment);
        text.push('\n');
    }
    text
}
