//! Printed and verified numbers: `MATH.md` section 10 rows 19 to 23 and section 7.

use antumbra::encoding::convolution::{
    ANTUMBRA_CONVOLUTION_RANGE, antumbra_convolution_part, antumbra_convolution_terms,
};
use antumbra::encoding::depth::antumbra_lookup;
use antumbra::encoding::exponential::{
    antumbra_exponential_lit, antumbra_exponential_variance_lit, antumbra_exponential_variance_lit_two,
    antumbra_warped_depth,
};
use antumbra::encoding::moments::{
    antumbra_moments_lit, antumbra_moments_lit_within, antumbra_moments_packed, antumbra_moments_roots,
    antumbra_moments_unpacked,
};
use antumbra::encoding::read::antumbra_store;
use antumbra::encoding::variance::{antumbra_darkened, antumbra_variance_lit};
use antumbra::{
    Aabb, CONVOLUTION_TERMS, Camera, Encoding, FitInput, Light, MapBudget, MomentFormat, Moments, Pcf, Remix, Scene,
    ShadowTechnique, techniques,
};
use glam::{DVec3, Vec2, Vec4};

use crate::sets::Set;

/// Far below every variance here: 0 would divide by it.
const NO_LOSS: f32 = 1e-20;

#[track_caller]
fn near(found: f32, expected: f64, relative: f64) {
    let off = (f64::from(found) - expected).abs();
    assert!(off <= relative * expected.abs(), "{found} for {expected}, off by {:.1e}", off / expected.abs());
}

#[test]
fn row_19_chebyshev() {
    let two = Set::even(&[0.25, 0.75]).variance();
    near(antumbra_variance_lit(two, 0.75, NO_LOSS), 0.5, 1e-6);
    let lit = antumbra_variance_lit(two, 0.9, NO_LOSS);
    near(lit, 0.280_898_876_404_494_4, 1e-6);
    near(antumbra_darkened(lit, 0.2), 0.101_123_595_505_617_98, 2e-6);
    // TH-14: bleeding of overlapping casters, truth 0.
    near(antumbra_variance_lit(Set::even(&[0.2, 0.6]).variance(), 0.7, NO_LOSS), 0.307_692_307_692_307_7, 1e-6);
}

#[test]
fn row_20_exponentials() {
    near(antumbra_exponential_lit(0.4, 0.5, 80.0), 3.354_626_279_025_118_4e-4, 1e-5);
    near(antumbra_exponential_lit(0.4, 0.5, 30.0), 0.049_787_068, 1e-5);
    near(antumbra_warped_depth(0.4, Vec2::splat(5.54)).x, 0.330_218_738_554_893_34, 1e-6);
    // What two overlapping casters let through: 9 times and 10 million times less than variance alone.
    let overlap = Set::even(&[0.2, 0.6]);
    for (exponents, positive, negative, tolerance) in
        [(Vec2::splat(5.54), 0.036_95, 0.4920, 2e-3), (Vec2::new(40.0, 8.0), 2.8e-8, 0.4987, 3e-2)]
    {
        let moments = overlap.exponential_variance(exponents);
        let two = Vec2::new(moments.x, moments.y);
        near(antumbra_exponential_variance_lit_two(two, 0.7, exponents, 1e-12), positive, tolerance);
        near(antumbra_exponential_variance_lit(moments, 0.7, exponents, 1e-12), positive, tolerance);
        // The negative side alone, by hand.
        let warped = -(-f64::from(exponents.y) * 0.4).exp();
        let (mean, square) = (f64::from(moments.z), f64::from(moments.w));
        let variance = square - mean * mean;
        near((variance / (variance + (warped - mean).powi(2))) as f32, negative, 1e-3);
    }
}

/// Exponents just below half the logarithm of the largest number, and just above.
#[test]
fn exponents_end_where_formats_do() {
    let largest_half = 65_504.0_f32;
    let square = |exponent: f32| antumbra_warped_depth(1.0, Vec2::splat(exponent)).x.powi(2);
    near(square(5.54), 64_860.9, 1e-4);
    assert!(square(5.54) < largest_half && square(5.55) > largest_half);
    near(square(42.0), 3.025e36, 1e-3);
    assert!(square(44.3).is_finite() && square(44.4).is_infinite());
    near(f32::MAX / square(42.0), 112.0, 1e-2);
}

#[test]
fn row_21_convolution() {
    // The depths of the reference are those of the series, which holds ours scaled.
    let sum = |behind: f32| {
        let (caster, receiver) = (0.5 + behind / ANTUMBRA_CONVOLUTION_RANGE, 0.5);
        let part = |term| antumbra_convolution_part(antumbra_convolution_terms(caster, term), receiver, term);
        0.5 + (0..16).step_by(2).map(part).sum::<f32>()
    };
    near(sum(0.1), 1.027_308_800_460_070_7, 2e-6);
    near(sum(0.03), 1.088_830_546_431_044, 2e-6);
    near(sum(-0.1), -0.027_308_800_460_070_69, 1e-4);
    near(sum(0.0), 0.5, 1e-6);
    // Gibbs: the overshoot of 9 % at 1/(2M).
    near(sum(1.0 / 32.0), 1.0897, 1e-3);
}

#[test]
fn row_22_four_moments() {
    let set = Set(vec![(0.2, 0.3), (0.5, 0.5), (0.9, 0.2)]);
    let b = set.moments();
    let shadow = |depth: f32| 1.0 - antumbra_moments_lit(b, depth, 0.0);
    near(shadow(0.55), 0.368_482_666_222_736_4, 2e-5);
    near(shadow(0.7), 0.507_976_701_150_342_9, 2e-5);
    near(shadow(0.95), 0.866_631_226_410_079_2, 2e-5);
    let roots = (antumbra_moments_roots(b, 2.0 * 0.55 - 1.0) + 1.0) / 2.0;
    near(roots.x, 0.222_194_798_210_240_93, 2e-5);
    near(roots.y, 0.926_773_036_643_335_6, 2e-5);
    let within = |depth: f32| 1.0 - antumbra_moments_lit_within(b, depth, 0.0);
    near(within(0.7), 0.571_813_75, 2e-5);
    near(within(0.3), 0.024_007_53, 1e-3);
    // Where the least distribution on the line stays within the range there is nothing to gain.
    assert_eq!(within(0.55), shadow(0.55));
}

/// A plane at 60°, across both axes of the map alike: how far receivers are lifted along the light, which is that far
/// over the cosine along the normal. The reference is for texels of 0.05; the shader adds what rounding may take.
#[test]
fn row_23_slope_bias() {
    let remix = Remix { encoding: Encoding::Depth(Pcf::Point), ..techniques::ssm() };
    let input = FitInput {
        camera: Camera::perspective(glam::DMat4::IDENTITY, 1.0, 1.0, 0.1, 100.0),
        light: Light::Directional { travel: DVec3::new(0.3, -0.9, 0.2).normalize() },
        scene: Scene::within(Aabb::new(DVec3::splat(-20.0), DVec3::splat(20.0))),
        map: MapBudget::one(1024),
        origin: DVec3::ZERO,
        previous: None,
    };
    let frame = remix.fit(&input).unwrap();
    let view = &frame.uniforms.views[0];
    let [u, v, depth] =
        [view.u_from_render, view.v_from_render, view.depth_from_render].map(|row| Vec4::from_array(row).truncate());
    let (cosine, sine) = (0.5_f32, 0.75_f32.sqrt());
    let normal = sine * (u.normalize() + v.normalize()).normalize() - cosine * depth.normalize();
    let at = |normal| antumbra_lookup(view, glam::Vec3::ZERO, normal, 0.5, 0.5).depth;
    let lift = (at(glam::Vec3::ZERO) - at(normal)) / depth.length();
    // Texels of this map are not square: with equal shares of both axes their mean side counts.
    let sides = frame.views[0].texel.world;
    let mean = 0.5 * (sides[0] + sides[1]);
    let scale = mean / 0.05 * (0.5 + view.bias[0]) / 0.5;
    near(lift, 0.061_237_243_569_579_45 * f64::from(scale), 1e-3);
    near(lift * cosine, 0.030_618_621_784_789_72 * f64::from(scale), 1e-3);
}

/// 0.5 stored everywhere and read at 0.51: what a bias for 16 bits lets through.
#[test]
fn bias_of_sixteen_bits_leaks_at_contacts() {
    let b = Set::even(&[0.5]).moments();
    let shadow = 1.0 - antumbra_moments_lit(b, 0.51, 6e-5);
    println!("a caster at 0.5, a receiver at 0.51, bias 6e-5: shadow {shadow}");
    assert!((0.80..0.999).contains(&shadow), "{shadow}");
    assert!(1.0 - antumbra_moments_lit(b, 0.51, 1e-6) > 0.99);
}

#[test]
fn packed_moments_come_back() {
    let mut worst = 0.0_f32;
    for step in 0..=1000_u16 {
        let b = Set::even(&[f32::from(step) / 1000.0, f32::from(step % 37) / 36.0]).moments();
        let packed = antumbra_moments_packed(b);
        assert!(packed.min_element() >= -1e-6 && packed.max_element() <= 1.0 + 1e-6, "{packed}");
        worst = worst.max((antumbra_moments_unpacked(packed) - b).abs().max_element());
    }
    assert!(worst < 1e-6, "{worst}");
}

/// Integers hold no less than 0 and no more than 1: what is stored of any depth is within them.
#[test]
fn integers_hold_what_is_stored() {
    let integers = |moments: &Moments| {
        matches!(moments.format(), MomentFormat::Unorm16 | MomentFormat::Unorm8 | MomentFormat::Summed)
    };
    for moments in Moments::all().filter(integers) {
        for step in 0..=1000 {
            let depth = step as f32 / 1000.0;
            for term in (0..CONVOLUTION_TERMS).step_by(2) {
                let stored = antumbra_store(moments, depth, term);
                let held = stored.clamp(Vec4::splat(-1e-6), Vec4::splat(1.0 + 1e-6));
                assert_eq!(stored, held, "{moments:?} at {depth}");
            }
        }
    }
}
