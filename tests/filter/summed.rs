//! Summed-area tables in memory: exact, wrapping around without a trace; what is read of them is the mean over the
//! receiver's own box, within its tile.

use antumbra::encoding::blur::antumbra_blur_radius;
use antumbra::encoding::depth::{CompareMap, DepthMap, antumbra_visible};
use antumbra::encoding::read::antumbra_store;
use antumbra::encoding::split::OnMap;
use antumbra::encoding::summed::{
    ANTUMBRA_BOX_MOST, ANTUMBRA_BOX_STEPS, antumbra_counted, antumbra_half_widths, antumbra_summed,
};
use antumbra::lab::moments::MomentMap;
use antumbra::{
    Encoding, FitError, Light, MapBudget, MomentFormat, MomentKind, Moments, Part, Prefilter, Radius, Remix,
    ShadowFrame, ShadowView, ViewUniforms, Why, techniques,
};
use glam::{DVec3, UVec2, UVec4, Vec2, Vec3, Vec4};

use crate::dice::Dice;
use crate::poison::POISON;
use crate::stage::{SIZE, encoding, filtered, fit, tiled};
use crate::support;

/// All that is summed.
pub(crate) fn summed() -> impl Iterator<Item = Moments> {
    let all: Vec<Moments> = Moments::all().filter(|moments| moments.is_summed()).collect();
    assert_eq!(all.len(), 3);
    all.into_iter()
}

fn variance() -> Moments {
    Moments::new(MomentKind::Variance, MomentFormat::Summed)
}

/// A frame of one map, and random depths in all its texels.
fn noise(moments: Moments, radius: Radius, side: u32, dice: &mut Dice) -> (ShadowFrame, Vec<f32>) {
    let remix = Remix { encoding: encoding(moments, radius, false), ..techniques::fsm() };
    let frame = fit(&remix, MapBudget::one(side));
    (frame, (0..side * side).map(|_| dice.single(0.0, 1.0)).collect())
}

/// What a texel of a tile adds to sums: differences of its neighbours' that are in the tile.
pub(crate) fn texel(sums: &[UVec4], side: u32, view: &ShadowView, at: UVec2) -> UVec4 {
    let [left, top, ..] = view.blur.tile;
    let before = |dx: u32, dy: u32| {
        let inside = at.x >= left + dx && at.y >= top + dy;
        if inside { sums[((at.y - dy) * side + at.x - dx) as usize] } else { UVec4::ZERO }
    };
    before(0, 0).wrapping_sub(before(1, 0)).wrapping_sub(before(0, 1)).wrapping_add(before(1, 1))
}

pub(crate) fn counted(moments: Moments, depth: f32) -> UVec4 {
    antumbra_counted(antumbra_store(moments, depth, 0))
}

/// Boxes that begin and end between texels are the sums of their texels, divided by their number: integers, exactly,
/// up to the widest box, though the map as a whole sums to more than 32 bits hold.
#[test]
fn boxes_are_direct_sums() {
    const SIDE: u32 = 400;
    let mut dice = Dice::new(41);
    for moments in summed() {
        let (frame, mut depths) = noise(moments, Radius::Texels(1.5), SIDE, &mut dice);
        // Far away: the largest numbers there are, so that the whole wraps around.
        depths.iter_mut().skip(1000).for_each(|depth| *depth = 1.0 - 0.1 * *depth);
        let map = filtered(moments, &frame, std::slice::from_ref(&depths)).remove(0);
        let whole = depths.iter().map(|depth| u64::from(counted(moments, *depth).x.max(counted(moments, *depth).w)));
        let whole: u64 = whole.sum();
        assert!(whole > 1 << 32, "{moments:?}: {whole}");
        for _ in 0..200 {
            let half = [dice.below(128).max(1), dice.below(128).max(1)].map(|half| half as u32);
            let place = half.map(|half| half + 2 + dice.below((SIDE - 2 * half - 3) as usize) as u32);
            let sum = (place[1] - half[1]..place[1] + half[1])
                .flat_map(|y| (place[0] - half[0]..place[0] + half[0]).map(move |x| (y * SIDE + x) as usize))
                .map(|index| counted(moments, depths[index]).to_array().map(u64::from))
                .fold([0; 4], |sum: [u64; 4], texel| core::array::from_fn(|number| sum[number] + texel[number]));
            let texels = f64::from(4 * half[0] * half[1]) * f64::from(ANTUMBRA_BOX_STEPS);
            let uv = Vec2::from(place.map(|at| at as f32)) / SIDE as f32;
            let radius = Vec2::from(half.map(|half| half as f32));
            let found = antumbra_summed(&map, &frame.uniforms.views[0], uv, radius);
            for (found, sum) in found.to_array().into_iter().zip(sum) {
                // The sum itself is exact: one rounding to f32, one of the divisor, one of the quotient; places are
                // rounded by 2⁻¹⁵ texels, of which the box has at least two.
                let expected = sum as f64 / texels;
                let bound = 3.0 * f64::from(f32::EPSILON) + 4.0 / f64::from(1 << 15) / f64::from(half[0].min(half[1]));
                assert!((f64::from(found) - expected).abs() <= bound, "{moments:?}: {found} for {expected}");
            }
        }
    }
}

/// Where boxes end on texels' rims, the integers are the same ones, bit by bit: sums of the table against sums of
/// texels, at every place of a map and for the whole of it.
#[test]
fn tables_are_exact_in_integers() {
    const SIDE: u32 = 300;
    let mut dice = Dice::new(42);
    for moments in summed() {
        let (frame, depths) = noise(moments, Radius::Texels(1.5), SIDE, &mut dice);
        let map = filtered(moments, &frame, std::slice::from_ref(&depths)).remove(0);
        let sums: Vec<UVec4> = places(SIDE).map(|at| map.sum(at.as_ivec2())).collect();
        for at in places(SIDE) {
            let depth = depths[(at.y * SIDE + at.x) as usize];
            assert_eq!(texel(&sums, SIDE, &frame.views[0], at), counted(moments, depth), "{moments:?} at {at}");
        }
        let last = depths.iter().fold(UVec4::ZERO, |sum, depth| sum.wrapping_add(counted(moments, *depth)));
        assert_eq!(sums[sums.len() - 1], last);
    }
}

pub(crate) fn places(side: u32) -> impl Iterator<Item = UVec2> {
    (0..side * side).map(move |index| UVec2::new(index % side, index / side))
}

/// At the centre of every texel, boxes of any half-width up to the widest that is blurred are what a map of 16 bits is
/// blurred to, the rim included, to the steps that both round to: half a one of every texel here, half a one with each
/// of the two passes there.
#[test]
fn boxes_are_those_of_the_blur() {
    const SIDE: u32 = 256;
    let mut dice = Dice::new(47);
    for moments in summed() {
        let mut worst = 0.0_f32;
        for radius in [0.0, 0.5, 0.8, 1.5, 2.3, 7.0, 20.6, 32.0] {
            let (frame, depths) = noise(moments, Radius::Texels(radius), SIDE, &mut dice);
            let table = filtered(moments, &frame, std::slice::from_ref(&depths)).remove(0);
            let blurred = Moments::new(moments.kind(), MomentFormat::Unorm16);
            let blurred = filtered(blurred, &frame, &[depths]).remove(0);
            for at in places(SIDE) {
                let uv = (at.as_vec2() + 0.5) / SIDE as f32;
                let found = antumbra_summed(&table, &frame.uniforms.views[0], uv, Vec2::splat(radius));
                worst = worst.max((found - blurred.texel(0, 0, at)).abs().max_element());
            }
        }
        println!("{}: {:.3} steps apart", moments.kind().name(), worst * ANTUMBRA_BOX_STEPS);
        assert!(worst * ANTUMBRA_BOX_STEPS < 1.5 + 0.1, "{moments:?}: {worst}");
    }
}

/// The widest box of the largest numbers fits 32 bits, ends within texels included; one texel more to a side would not.
#[test]
fn the_widest_box_fits() {
    let nodes = f64::from(2.0 * ANTUMBRA_BOX_MOST) + 2.0;
    assert!(nodes * nodes * f64::from(ANTUMBRA_BOX_STEPS) <= f64::from(u32::MAX));
    assert!((nodes + 1.0).powi(2) * f64::from(ANTUMBRA_BOX_STEPS) > f64::from(u32::MAX));
}

/// The passes on an adapter make the table that memory makes: every texel adds what it should, to a step of rounding,
/// A map of sums whose boxes end on texels' rims draws what a map that is blurred over the same box draws, in 16 bits
/// Half-widths at a receiver are those of the blur at the texel that it is in; a point where u and v are places.
#[test]
fn half_widths_are_those_of_the_blur() {
    let mut dice = Dice::new(43);
    let mut worst = 0.0_f32;
    for technique in [techniques::fsm(), techniques::tsm(), techniques::lispsm()] {
        for radius in [Radius::Texels(5.5), Radius::World(0.15)] {
            let remix = Remix { encoding: encoding(variance(), radius, false), guard: false, ..technique };
            let frame = fit(&remix, MapBudget::one(512));
            let (view, blur) = (&frame.uniforms.views[0], &frame.views[0].blur);
            let mut checked = 0;
            for _ in 0..4000 {
                let position = dice.vector(8.0);
                let at = position.extend(1.0);
                let of = |row| Vec4::from_array(row).dot(at);
                let uv = Vec2::new(of(view.u_from_render), of(view.v_from_render)) / of(view.w_from_render);
                // Where neither is narrowed.
                let texel = uv * 512.0 - 0.5;
                if !(texel.min_element() > 70.0 && texel.max_element() < 442.0) {
                    continue;
                }
                let (expected, found) = (antumbra_blur_radius(blur, texel), antumbra_half_widths(view, position, uv));
                if expected.max_element() < 32.0 {
                    worst = worst.max(((found - expected) / expected).abs().max_element());
                    checked += 1;
                }
            }
            assert!(checked > 50, "{checked}");
        }
    }
    println!("half-widths differ by {worst:.1e} of themselves");
    assert!(worst < 1e-4, "{worst}");
}

/// Means are continuous in place and width, up to the widest box: neither shows where a texel comes in.
#[test]
fn boxes_are_continuous() {
    let mut dice = Dice::new(44);
    let (frame, depths) = noise(variance(), Radius::Texels(1.5), 300, &mut dice);
    let map = filtered(variance(), &frame, &[depths]).remove(0);
    let read =
        |texel: Vec2, radius: f32| antumbra_summed(&map, &frame.uniforms.views[0], texel / 300.0, Vec2::splat(radius));
    let step = 1.0 / 256.0;
    for index in 0..127 * 256 {
        let radius = index as f32 * step;
        let jump = (read(Vec2::new(149.3, 151.8), radius + step) - read(Vec2::new(149.3, 151.8), radius)).abs();
        // A box of width 2r or more gains 4 steps of 2r texels at most, and they differ by 1.
        assert!(jump.max_element() <= 4.0 * step / radius.max(0.5) + 1e-5, "radius {radius}: {jump}");
    }
    for index in 0..300 * 64 {
        let at = index as f32 / 64.0;
        let jump = (read(Vec2::new(at, 150.0), 2.7) - read(Vec2::new(at + 1.0 / 64.0, 150.0), 2.7)).abs();
        // Towards the rim the box is a texel wide, and moves and narrows by as much.
        assert!(jump.max_element() <= 4.0 / 64.0 + 1e-5, "{at}: {jump}");
    }
    // One texel wide it is what is stored there.
    for at in [UVec2::new(0, 0), UVec2::new(150, 7), UVec2::new(299, 299)] {
        let (found, stored) = (read(at.as_vec2() + 0.5, 0.0), map.texel(0, 0, at));
        assert!((found - stored).abs().max_element() < 2e-4, "{found} for {stored}");
    }
}

/// Whatever neighbours hold, no tile's box reads it, anywhere, as wide as can be.
#[test]
fn neighbours_are_not_read() {
    const SIDE: u32 = 250;
    for moments in summed() {
        let (remix, map) = tiled(encoding(moments, Radius::Texels(3.0), false), SIDE);
        let frame = fit(&remix, map);
        let mut checked = 0;
        for (view, uniforms) in frame.views.iter().zip(&frame.uniforms.views) {
            let [left, top, tile, _] = view.blur.tile;
            let layer = |beside: f32| -> Vec<f32> {
                let depth = |at: UVec2| {
                    let within = (left..left + tile).contains(&at.x) && (top..top + tile).contains(&at.y);
                    if within { 0.5 + 0.001 * (at.x % 7) as f32 } else { beside }
                };
                places(SIDE).map(depth).collect()
            };
            let depths = |beside| (0..frame.map.layers).map(|_| layer(beside)).collect::<Vec<_>>();
            let [near, far] = [0.0, 1.0].map(|beside| filtered(moments, &frame, &depths(beside)));
            for step in 0..=400 {
                let share = step as f32 / 400.0 * 3.0 - 1.0;
                for radius in [0.0, 2.5, 31.7, ANTUMBRA_BOX_MOST] {
                    for uv in [Vec2::splat(share), Vec2::new(share, 0.4), Vec2::new(0.3, 1.0 - share)] {
                        let read = |maps: &[MomentMap]| {
                            antumbra_summed(&OnMap::of(uniforms, maps).unwrap(), uniforms, uv, Vec2::splat(radius))
                        };
                        assert_eq!(read(&near), read(&far), "{moments:?}, {uv}, {radius}");
                        checked += usize::from(tile < SIDE);
                    }
                }
            }
        }
        assert!(checked > 10_000, "{checked}");
    }
}

/// Depths that are none are light, and change nothing that their box does not hold: differences of sums behind them are
/// what they were, bit by bit.
#[test]
fn poison_stays_in_its_box() {
    const SIDE: u32 = 96;
    let mut dice = Dice::new(45);
    for moments in summed() {
        let (frame, clean) = noise(moments, Radius::Texels(4.5), SIDE, &mut dice);
        let mut poisoned = clean.clone();
        let spots: Vec<usize> = POISON.iter().map(|_| dice.below(poisoned.len())).collect();
        spots.iter().zip(POISON).for_each(|(spot, poison)| poisoned[*spot] = poison);
        let [clean, poisoned] = [clean, poisoned].map(|depths| filtered(moments, &frame, &[depths]).remove(0));
        let mut changed = 0;
        for at in places(SIDE) {
            let read = |map| {
                let uv = (at.as_vec2() + 0.5) / SIDE as f32;
                antumbra_summed(map, &frame.uniforms.views[0], uv, Vec2::splat(4.5))
            };
            let (before, after) = (read(&clean), read(&poisoned));
            let near = spots.iter().any(|spot| {
                let spot = UVec2::new(*spot as u32 % SIDE, *spot as u32 / SIDE).as_ivec2();
                (spot - at.as_ivec2()).abs().max_element() <= 5
            });
            assert!(after.is_finite() && (near || before == after), "{moments:?}: {before} became {after} at {at}");
            changed += usize::from(before != after);
        }
        assert!(changed > 20, "{moments:?}: {changed}");
        for _ in 0..2000 {
            let (at, normal) = (dice.vector(15.0), dice.direction().as_vec3());
            let lit = antumbra_visible(frame.wgsl, &frame.uniforms.views[0], &poisoned, at, normal);
            assert!((0.0..=1.0).contains(&lit), "{moments:?}: {lit} at {at}");
        }
    }
}

/// Lookups that are none end in a number: places, widths and views without one.
#[test]
fn hostile_lookups_end() {
    let mut dice = Dice::new(46);
    let (frame, depths) = noise(variance(), Radius::Texels(4.5), 32, &mut dice);
    let map = filtered(variance(), &frame, std::slice::from_ref(&depths)).remove(0);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -f32::MAX, 0.0, -1.0, 1e-38];
    for _ in 0..20_000 {
        let any = |dice: &mut Dice| bad[dice.below(bad.len())];
        let mut view: ViewUniforms = frame.uniforms.views[0];
        let uv = Vec2::new(any(&mut dice), any(&mut dice));
        if dice.below(2) == 0 {
            view.rect[dice.below(4)] = any(&mut dice);
        }
        view.moments[3] = any(&mut dice);
        let position = Vec3::new(any(&mut dice), any(&mut dice), any(&mut dice));
        let radius = antumbra_half_widths(&view, position, uv);
        let _ = antumbra_summed(&map, &view, uv, radius);
        let lit = antumbra_visible(frame.wgsl, &view, &map, position, Vec3::Y);
        assert!((0.0..=1.0).contains(&lit), "{lit}");
    }
    // Maps without sums have none.
    assert_eq!(DepthMap { size: UVec2::splat(32), depth: &depths }.sum(UVec2::ZERO.as_ivec2()), UVec4::ZERO);
}

/// Bells and mips are said to be left out, and are; widths reach farther than those of other formats.
#[test]
fn what_sums_cannot_is_said() {
    let of = |moments: Moments, radius, bell| Remix {
        encoding: Encoding::Moments(Prefilter { radius: Radius::Texels(radius), bell, ..Prefilter::of(moments) }),
        ..techniques::fsm()
    };
    let map = MapBudget::one(512);
    for (remix, said) in [
        (of(variance(), 3.0, false), false),
        (of(variance(), 3.0, true), true),
        (of(variance().read(true, true), 3.0, false), true),
        (of(Moments::new(MomentKind::Variance, MomentFormat::Unorm16), 3.0, true), false),
    ] {
        let frame = fit(&remix, map);
        let cut = frame.left_out.iter().any(|cut| (cut.part, cut.why) == (Part::Light, Why::SumsAreBoxes));
        assert_eq!(cut, said, "{remix:?}: {:?}", frame.left_out);
        let summed = matches!(remix.encoding, Encoding::Moments(prefilter) if prefilter.moments.is_summed());
        assert_eq!(frame.views[0].blur.bell, u32::from(!summed));
    }
    assert_eq!(fit(&of(variance(), 127.0, false), map).uniforms.views[0].moments[3], -127.0);
    let input = |remix: &Remix| {
        let scene = antumbra::Scene::within(support::bounds(&support::boxes()));
        let light = Light::Directional { travel: support::travel() };
        let camera = support::camera(SIZE);
        let input = antumbra::FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous: None };
        antumbra::ShadowTechnique::fit(remix, &input)
    };
    let blurred = Moments::new(MomentKind::Variance, MomentFormat::Unorm16);
    for (moments, radius, legal) in [(variance(), 127.5, "0 to 127"), (blurred, 32.5, "0 to 32")] {
        let error = input(&of(moments, radius, false)).map(|_| ()).unwrap_err();
        let expected = FitError::OutOfRange { field: "encoding.radius", value: f64::from(radius), legal };
        assert_eq!(error, expected);
    }
}
