//! The shaders on an adapter, against their twins.
//!
//! A shader may compute every operation in another order or fused. Its result has to be what the twin gives for some
//! numbers within a few rounding steps of those it was given (a backward error): moments are products of numbers up to
//! their largest, so that they move by steps of that; depths by steps of 1.

use antumbra::encoding::convolution::{antumbra_convolution_lit, antumbra_convolution_part};
use antumbra::encoding::exponential::{
    antumbra_exponential_lit, antumbra_exponential_mean, antumbra_exponential_part, antumbra_exponential_variance_lit,
    antumbra_exponential_variance_lit_two, antumbra_exponential_variance_moments,
};
use antumbra::encoding::moments::{
    ANTUMBRA_MOMENTS_BIAS, antumbra_moments, antumbra_moments_lit, antumbra_moments_lit_within,
    antumbra_moments_packed, antumbra_moments_unpacked,
};
use antumbra::encoding::variance::{
    antumbra_darkened, antumbra_variance_lit, antumbra_variance_moments, antumbra_variance_packed,
    antumbra_variance_unpacked,
};
use antumbra::transpile::Shader;
use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec4, Vec4Swizzles};

use crate::dice::Dice;
use crate::sets::Set;
use crate::support;
use crate::support::compute::compute;

const FRAGMENTS: [&str; 22] = [
    include_str!("../../shaders/darkened.wgsl"),
    include_str!("../../shaders/chebyshev.wgsl"),
    include_str!("../../shaders/variance.wgsl"),
    include_str!("../../shaders/variance_stored.wgsl"),
    include_str!("../../shaders/variance_packed.wgsl"),
    include_str!("../../shaders/variance_unpacked.wgsl"),
    include_str!("../../shaders/exponential.wgsl"),
    include_str!("../../shaders/exponential_stored.wgsl"),
    include_str!("../../shaders/exponential_mean.wgsl"),
    include_str!("../../shaders/exponential_variance.wgsl"),
    include_str!("../../shaders/exponential_variance_stored.wgsl"),
    include_str!("../../shaders/exponential_variance_two.wgsl"),
    include_str!("../../shaders/exponential_variance_four.wgsl"),
    include_str!("../../shaders/convolution.wgsl"),
    include_str!("../../shaders/convolution_read.wgsl"),
    include_str!("../../shaders/moments.wgsl"),
    include_str!("../../shaders/moments_stored.wgsl"),
    include_str!("../../shaders/moments_hamburger.wgsl"),
    include_str!("../../shaders/moments_lit.wgsl"),
    include_str!("../../shaders/moments_hausdorff.wgsl"),
    include_str!("../../shaders/moments_packed.wgsl"),
    include_str!("../../shaders/moments_unpacked.wgsl"),
];

const LOSS: f32 = 5e-7;
const BLUR: f32 = 1e-4;
const EXPONENTS: Vec2 = Vec2::new(40.0, 8.0);

/// A filtered texel of each kind, and the receiver.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Case {
    bent: Vec4,
    terms: Vec4,
    four: Vec4,
    /// Two moments, the exponential mean, and the receiver's depth.
    rest: Vec4,
}

/// What is read, and what a texel stores of the receiver's depth.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Found {
    /// Variance, darkened, EVSM2, EVSM4.
    first: Vec4,
    /// Exponential, convolution, Hamburger, Hausdorff.
    second: Vec4,
    bent: Vec4,
    four: Vec4,
    packed: Vec4,
    unpacked: Vec4,
    /// Two moments, a part and the mean.
    rest: Vec4,
    /// Two moments packed, and unpacked.
    two: Vec4,
}

const SHADER: &str = "
struct Case { bent: vec4f, terms: vec4f, four: vec4f, rest: vec4f }
struct Found { first: vec4f, second: vec4f, bent: vec4f, four: vec4f, packed: vec4f, unpacked: vec4f, rest: vec4f, two: vec4f }
@group(0) @binding(0) var<storage, read> cases: array<Case>;
@group(0) @binding(1) var<storage, read_write> found: array<Found>;
const EXPONENTS = vec2f(40.0, 8.0);
@compute @workgroup_size(64) fn run(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&cases) {
        let at = cases[id.x];
        let depth = at.rest.w;
        let variance = antumbra_variance_lit(at.rest.xy, depth, 5e-7);
        let part = antumbra_exponential_part(depth, 1.0, 80.0);
        var one: Found;
        one.first = vec4f(
            variance,
            antumbra_darkened(variance, 0.2),
            antumbra_exponential_variance_lit_two(at.bent.xy, depth, EXPONENTS, 1e-4),
            antumbra_exponential_variance_lit(at.bent, depth, EXPONENTS, 1e-4),
        );
        one.second = vec4f(
            antumbra_exponential_lit(at.rest.z, depth, 80.0),
            antumbra_convolution_lit(0.5 + antumbra_convolution_part(at.terms, depth, 0u)),
            antumbra_moments_lit(at.four, depth, 1e-6),
            antumbra_moments_lit_within(at.four, depth, 1e-6),
        );
        one.bent = antumbra_exponential_variance_moments(depth, EXPONENTS);
        one.four = antumbra_moments(depth);
        one.packed = antumbra_moments_packed(at.four);
        one.unpacked = antumbra_moments_unpacked(one.packed);
        one.rest = vec4f(antumbra_variance_moments(depth), part, antumbra_exponential_mean(part, 1.0, 80.0));
        let packed = antumbra_variance_packed(at.rest.xy);
        one.two = vec4f(packed, antumbra_variance_unpacked(packed));
        found[id.x] = one;
    }
}";

impl Case {
    fn of(set: &Set, depth: f32) -> Self {
        let rest = set.variance().extend(set.exponential(80.0)).extend(depth);
        Self { bent: set.exponential_variance(EXPONENTS), terms: set.convolution(0), four: set.moments(), rest }
    }

    /// What the twins read.
    fn lit(&self) -> [f32; 8] {
        let depth = self.rest.w;
        let variance = antumbra_variance_lit(self.rest.xy(), depth, LOSS);
        [
            variance,
            antumbra_darkened(variance, 0.2),
            antumbra_exponential_variance_lit_two(self.bent.xy(), depth, EXPONENTS, BLUR),
            antumbra_exponential_variance_lit(self.bent, depth, EXPONENTS, BLUR),
            antumbra_exponential_lit(self.rest.z, depth, 80.0),
            antumbra_convolution_lit(0.5 + antumbra_convolution_part(self.terms, depth, 0)),
            antumbra_moments_lit(self.four, depth, ANTUMBRA_MOMENTS_BIAS),
            antumbra_moments_lit_within(self.four, depth, ANTUMBRA_MOMENTS_BIAS),
        ]
    }

    /// The same case, every number moved by up to `steps` rounding steps.
    fn moved(&self, steps: f32, dice: &mut Dice) -> Self {
        let step = steps * f32::EPSILON;
        let mut by = |size: f32| dice.single(-1.0, 1.0) * step * size;
        // A bent moment is rounded to its own size: exponentials to (3 + 2|x|) steps.
        let bent = self.bent.to_array().map(|moment| moment + by(moment));
        let four = self.four.to_array().map(|moment| moment + by(1.0));
        let terms = self.terms.to_array().map(|term| term + by(1.0));
        let rest = [self.rest.x + by(0.5), self.rest.y + by(0.25), self.rest.z + by(1.0), self.rest.w + by(1.0)];
        Self { bent: bent.into(), terms: terms.into(), four: four.into(), rest: rest.into() }
    }
}

/// Rounding steps within which a case may have been another one.
const STEPS: f32 = 8.0;

/// Other cases that are tried within those steps: enough that the widest of them is found within a third.
const TRIES: usize = 48;

#[test]
fn shaders_agree_with_their_twins() {
    let Some(gpu) = support::gpu() else { return };
    let mut dice = Dice::new(31);
    let cases: Vec<Case> = (0..20_000)
        .map(|_| {
            let set = Set::hostile(&mut dice);
            Case::of(&set, set.receiver(&mut dice))
        })
        .collect();
    let text = [FRAGMENTS.join("\n").as_str(), SHADER].join("\n");
    let found: Vec<Found> = compute(&gpu, &text, &cases, &[]);
    let names = ["variance", "darkened", "EVSM2", "EVSM4", "exponential", "convolution", "Hamburger", "Hausdorff"];
    let (mut worst, mut beyond, mut vague) = ([0.0_f32; 8], [0_u32; 8], [0_u32; 8]);
    for (case, found) in cases.iter().zip(&found) {
        let expected = case.lit();
        let read = [found.first.to_array(), found.second.to_array()].concat();
        // How far the twin moves when its numbers do.
        let mut spread = [0.0_f32; 8];
        for _ in 0..TRIES {
            for ((spread, moved), expected) in spread.iter_mut().zip(case.moved(STEPS, &mut dice).lit()).zip(expected) {
                *spread = spread.max((moved - expected).abs());
            }
        }
        for index in 0..8 {
            assert!((0.0..=1.0).contains(&read[index]), "{}: {} for {case:?}", names[index], read[index]);
            let off = (read[index] - expected[index]).abs();
            let bound = 3.0 * spread[index] + 4.0 * f32::EPSILON;
            vague[index] += u32::from(bound > 0.01);
            beyond[index] += u32::from(off > bound);
            if bound <= 0.01 {
                worst[index] = worst[index].max(off);
            }
        }
        stored(case, found);
    }
    for (index, name) in names.iter().enumerate() {
        println!(
            "{name:12} differs by at most {:.1e} where rounding decides about less than 0.01 ({} of {} cases do not); \
             beyond the bound: {}",
            worst[index],
            vague[index],
            cases.len(),
            beyond[index]
        );
    }
    assert_eq!(beyond, [0; 8]);
    assert!(vague.iter().all(|vague| *vague < cases.len() as u32 / 4), "{vague:?}");
}

/// What texels store: to 2 rounding steps of 1, exponentials to (3 + 2|x|) of themselves.
fn stored(case: &Case, found: &Found) {
    let depth = case.rest.w;
    let close = |found: f32, expected: f32, bound: f32| {
        assert!((found - expected).abs() <= bound, "{found} for {expected}, depth {depth}");
    };
    let ulp = f32::EPSILON;
    for (found, expected) in found.four.to_array().into_iter().zip(antumbra_moments(depth).to_array()) {
        close(found, expected, 2.0 * ulp);
    }
    let packed = antumbra_moments_packed(case.four);
    for (found, expected) in found.packed.to_array().into_iter().zip(packed.to_array()) {
        close(found, expected, 8.0 * ulp);
    }
    for (found, expected) in found.unpacked.to_array().into_iter().zip(antumbra_moments_unpacked(packed).to_array()) {
        close(found, expected, 32.0 * ulp);
    }
    let bent = antumbra_exponential_variance_moments(depth, EXPONENTS).to_array();
    for (index, (found, expected)) in found.bent.to_array().into_iter().zip(bent).enumerate() {
        let exponent = [40.0, 8.0][index / 2];
        // The argument is rounded, and so is the exponential; squares have twice as much.
        close(found, expected, 2.0 * (3.0 + 4.0 * exponent) * ulp * expected.abs());
    }
    let two = antumbra_variance_moments(depth);
    close(found.rest.x, two.x, 2.0 * ulp);
    close(found.rest.y, two.y, 2.0 * ulp);
    let packed = antumbra_variance_packed(case.rest.xy());
    let two = packed.extend(0.0).extend(0.0) + Vec4::from((Vec2::ZERO, antumbra_variance_unpacked(packed)));
    for (found, expected) in found.two.to_array().into_iter().zip(two.to_array()) {
        close(found, expected, 2.0 * ulp);
    }
    let part = antumbra_exponential_part(depth, 1.0, 80.0);
    close(found.rest.z, part, (3.0 + 4.0 * 80.0) * ulp * part);
    close(found.rest.w, antumbra_exponential_mean(part, 1.0, 80.0), 8.0 * ulp);
}

/// The fragments keep the contract of the library: prefixes, no bindings, no derivatives, and text for every engine.
#[test]
fn fragments_keep_the_contract() {
    let text = FRAGMENTS.join("\n");
    let shader = Shader::parse(&text).unwrap_or_else(|error| panic!("{error}"));
    let functions = shader.module.functions.iter().filter_map(|(_, function)| function.name.clone());
    let constants = shader.module.constants.iter().filter_map(|(_, constant)| constant.name.clone());
    let names: Vec<String> = functions.chain(constants).collect();
    assert!(names.len() > 25, "{names:?}");
    assert!(names.iter().all(|name| name.starts_with("antumbra_") || name.starts_with("ANTUMBRA_")), "{names:?}");
    assert_eq!(shader.module.global_variables.len(), 0);
    assert!(shader.spirv().is_ok() && shader.hlsl().is_ok() && shader.msl().is_ok());
}
