//! Depths that are none, and casters with vertices that are none: they stay where they are, and nothing reads as more
//! or less than light.

use antumbra::encoding::blur::{antumbra_blur_radius, antumbra_blur_reach};
use antumbra::encoding::depth::antumbra_visible;
use antumbra::lab::gpu::{GpuScene, RenderOptions, Renderer, read_depth, read_moments};
use antumbra::lab::moments::MomentMap;
use antumbra::lab::scene::{SOLID, SceneModel};
use antumbra::{MapBudget, Moments, Radius, Remix, ShadowFrame, techniques};
use glam::{DVec3, UVec2, Vec2, Vec3, Vec4};

use crate::dice::Dice;
use crate::stage::{SIZE, Stage, encoding, filtered, fit};
use crate::support;

/// Side of a map, texels.
const SIDE: u32 = 96;

/// Depths that no map should hold.
pub(crate) const POISON: [f32; 7] =
    [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.4, -1.0, f32::MAX, -f32::MIN_POSITIVE];

/// Blurs of every kind.
fn blurs() -> [(Radius, bool); 4] {
    [
        (Radius::Texels(0.0), false),
        (Radius::Texels(4.5), false),
        (Radius::Texels(3.0), true),
        (Radius::World(0.4), true),
    ]
}

/// Texels that a blur reads to either side, anywhere in a view.
fn reach(frame: &ShadowFrame) -> i32 {
    let blur = &frame.views[0].blur;
    let texels = (0..SIDE * SIDE).map(|index| Vec2::new((index % SIDE) as f32, (index / SIDE) as f32));
    texels
        .map(|texel| antumbra_blur_reach(antumbra_blur_radius(blur, texel).max_element(), blur.bell != 0))
        .max()
        .unwrap()
}

/// Every texel of a level.
fn all(map: &MomentMap, moments: Moments, level: u32) -> impl Iterator<Item = (UVec2, Vec4)> {
    let side = SIDE >> level;
    (0..moments.layers()).flat_map(move |pair| {
        (0..side * side).map(move |index| {
            let at = UVec2::new(index % side, index / side);
            (at, map.texel(pair as usize, level as usize, at))
        })
    })
}

/// Lookups anywhere, at any depth, are shares of light.
fn shares(moments: Moments, frame: &ShadowFrame, map: &MomentMap, dice: &mut Dice) {
    for _ in 0..500 {
        let position = dice.vector(15.0);
        let lit = antumbra_visible(frame.wgsl, &frame.uniforms.views[0], map, position, dice.direction().as_vec3());
        assert!((0.0..=1.0).contains(&lit), "{moments:?}: {lit} at {position}");
    }
}

/// In memory, for every kind and format: poison is light, changes nothing beyond the reach of the blur, and leaves no
/// number that is none.
#[test]
fn poisoned_depths_stay_where_they_are() {
    let mut dice = Dice::new(7);
    for moments in Moments::all().filter(|moments| moments.mips) {
        for (index, (radius, bell)) in blurs().into_iter().enumerate() {
            let technique = if index % 2 == 0 { techniques::fsm() } else { techniques::tsm() };
            let remix = Remix { encoding: encoding(moments, radius, bell), guard: false, ..technique };
            let frame = fit(&remix, MapBudget::one(SIDE));
            let clean: Vec<f32> = (0..SIDE * SIDE).map(|_| dice.single(0.0, 1.0)).collect();
            let mut poisoned = clean.clone();
            let places: Vec<usize> = POISON.iter().map(|_| dice.below(poisoned.len())).collect();
            places.iter().zip(POISON).for_each(|(place, poison)| poisoned[*place] = poison);
            let [clean, poisoned] = [clean, poisoned].map(|depths| filtered(moments, &frame, &[depths]).remove(0));
            let reach = reach(&frame);
            let mut changed = 0;
            for ((at, before), (_, after)) in all(&clean, moments, 0).zip(all(&poisoned, moments, 0)) {
                assert!(after.is_finite(), "{moments:?}: {after} at {at}");
                let near = places.iter().any(|place| {
                    let place = UVec2::new(*place as u32 % SIDE, *place as u32 / SIDE).as_ivec2();
                    (place - at.as_ivec2()).abs().max_element() <= reach
                });
                assert!(near || before == after, "{moments:?}: {before} became {after} at {at}, reach {reach}");
                changed += usize::from(before != after);
            }
            assert!(changed > 0, "{moments:?}");
            for level in 0..=moments.last_level(SIDE) {
                assert!(all(&poisoned, moments, level).all(|(_, texel)| texel.is_finite()), "{moments:?}, {level}");
            }
            shares(moments, &frame, &poisoned, &mut dice);
        }
    }
}

/// A layer of nothing but poison is a layer without casters.
#[test]
fn nothing_but_poison_is_lit() {
    let mut dice = Dice::new(8);
    for moments in Moments::all().filter(|moments| moments.mips) {
        let remix = Remix { encoding: encoding(moments, Radius::Texels(4.5), true), ..techniques::lispsm() };
        let frame = fit(&remix, MapBudget::one(SIDE));
        for poison in POISON {
            let maps = [poison, 1.0].map(|depth| vec![depth; (SIDE * SIDE) as usize]);
            let [poisoned, empty] = maps.map(|depths| filtered(moments, &frame, &[depths]).remove(0));
            for level in 0..=moments.last_level(SIDE) {
                assert!(all(&poisoned, moments, level).eq(all(&empty, moments, level)), "{moments:?}, {poison}");
            }
        }
        let empty = filtered(moments, &frame, &[vec![1.0; (SIDE * SIDE) as usize]]).remove(0);
        for _ in 0..100 {
            let lit = antumbra_visible(frame.wgsl, &frame.uniforms.views[0], &empty, 5.0 * dice.vector(1.0), Vec3::Y);
            assert!(lit > 0.9, "{moments:?}: {lit}");
        }
    }
}

/// The boxes, and triangles with vertices that are none, infinite, enormous, or all in one line.
pub(crate) fn hostile() -> SceneModel {
    let mut model = support::boxes();
    let (start, far) = (model.triangles.len(), DVec3::splat(f64::from(f32::MAX)));
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let bad = [
        [DVec3::NAN, at(1.0, 3.0, 1.0), at(2.0, 3.0, 1.0)],
        [DVec3::NAN, DVec3::NAN, DVec3::NAN],
        [at(f64::NAN, 3.0, 0.0), at(1.0, f64::NAN, 1.0), at(2.0, 3.0, f64::NAN)],
        [DVec3::INFINITY, DVec3::INFINITY, DVec3::INFINITY],
        [DVec3::NEG_INFINITY, at(1.0, 3.0, 1.0), DVec3::NAN],
        [far, far, far],
        // Without area.
        [at(-3.0, 2.0, -3.0); 3],
        [at(-3.0, 2.0, -3.0), at(-2.0, 2.0, -3.0), at(-1.0, 2.0, -3.0)],
        [at(4.0, 2.0, 4.0), at(4.0, 2.0, 4.0), at(5.0, 2.0, 4.0)],
    ];
    for corners in bad {
        let first = model.positions.len() as u32;
        model.positions.extend(corners);
        model.uvs.extend([glam::DVec2::ZERO; 3]);
        model.triangles.push([first, first + 1, first + 2]);
        model.triangle_cutout.push(SOLID);
    }
    model.objects.push(start..model.triangles.len());
    model
}

/// On the adapter: maps stay finite and pictures what they were.
#[test]
fn hostile_casters_change_nothing() {
    let Some(stage) = Stage::new() else { return };
    let scene = GpuScene::upload(&stage.gpu, &hostile(), DVec3::ZERO).unwrap();
    assert!(scene.triangles() > stage.scene.triangles());
    let camera = support::camera(SIZE);
    for moments in stage.supported().filter(|moments| moments.mips) {
        for technique in [techniques::fsm(), techniques::tsm()] {
            let remix = Remix { encoding: encoding(moments, Radius::Texels(3.0), true), guard: false, ..technique };
            let frame = fit(&remix, MapBudget::one(256));
            let (maps, renderer) = (stage.maps(&frame), Renderer::new(&stage.gpu, frame.wgsl));
            let clean = stage.draw(&renderer, &frame, &maps);
            let options = RenderOptions::default();
            let picture = renderer.render(&stage.gpu, &scene, &camera, &frame, &maps, &options).unwrap().mask;
            let depths = read_depth(&stage.gpu, &maps, 0).unwrap();
            assert!(depths.iter().all(|depth| (0.0..=1.0).contains(depth)), "{moments:?}");
            for layer in 0..moments.layers() {
                for level in 0..=moments.last_level(256) {
                    let texels = read_moments(&stage.gpu, &maps, layer, level).unwrap();
                    assert!(texels.iter().all(|texel| texel.is_finite()), "{moments:?}, level {level}");
                }
            }
            let differ = clean.iter().zip(&picture).filter(|(clean, other)| clean != other).count();
            assert_eq!(differ, 0, "{moments:?}, {:?}", remix.warp);
            assert!(clean.iter().any(|lit| *lit < 40), "{moments:?}");
        }
    }
}
