//! Bugs of warped maps, verbatim: the input that showed each, and one sentence.

use antumbra::{
    Aabb, Camera, FitInput, Focus, Light, MapBudget, Projection, Remix, Scene, ShadowFrame, ShadowTechnique, Warp,
    techniques,
};
use glam::{DMat3, DMat4, DVec3, Vec4};

/// A camera by its axes (columns), eye in the world's origin, and its sides: left, right, down, up, near, far.
fn camera(axes: [[f64; 3]; 3], [left, right, down, up, near, far]: [f64; 6]) -> Camera {
    let world_from_view = DMat4::from_mat3(DMat3::from_cols_array_2d(&axes));
    let projection = Projection::Perspective { left, right, down, up, near, far };
    Camera { projection, ..Camera::perspective(world_from_view, 1.0, 1.0, 1.0, 2.0) }
}

fn input(
    camera: Camera,
    travel: [f64; 3],
    casters: [[f64; 3]; 2],
    receivers: [[f64; 3]; 2],
    side: u32,
) -> FitInput<'static> {
    let bounds = |[min, max]: [[f64; 3]; 2]| Aabb::new(DVec3::from_array(min), DVec3::from_array(max));
    FitInput {
        camera,
        light: Light::Directional { travel: DVec3::from_array(travel) },
        scene: Scene { casters: bounds(casters), receivers: bounds(receivers), ..Scene::within(Aabb::EMPTY) },
        map: MapBudget::one(side),
        origin: DVec3::ZERO,
        previous: None,
    }
}

fn fit(warp: Warp, guard: bool, input: &FitInput) -> ShadowFrame {
    Remix { warp, guard, ..Remix::default() }.fit(input).unwrap()
}

fn clip(frame: &ShadowFrame, at: [f64; 3]) -> Vec4 {
    frame.views[0].clip_from_render * DVec3::from_array(at).as_vec3().extend(1.0)
}

fn is_inside(clip: Vec4) -> bool {
    clip.w > 0.0 && clip.truncate().truncate().abs().max_element() <= clip.w
}

/// A corner of the window lay beyond the horizon, where it is behind the light's side of everything:
/// the near plane cut casters off.
#[test]
fn windows_that_reach_the_horizon_keep_their_casters() {
    let axes = [
        [-0.060_101_154_544_261_57, 0.386_941_284_143_110_6, -0.920_143_626_749_719_5],
        [0.386_941_284_143_110_6, 0.858_764_838_871_734_2, 0.335_856_210_517_663_3],
        [0.920_143_626_749_719_5, -0.335_856_210_517_663_3, -0.201_336_315_672_527_4],
    ];
    let sides = [
        -0.829_043_697_267_544_6,
        0.913_336_767_006_760_1,
        -0.550_558_795_431_495_6,
        0.550_558_795_431_495_6,
        0.005_117_695_745_808_491,
        11.515_048_055_608_197,
    ];
    let seen = [
        DVec3::new(-7.723_700_396_491_099, 5.241_905_746_300_540_5, 5.564_671_591_438_54),
        DVec3::new(-6.059_935_752_711_135_5, 1.073_117_183_923_701, -1.895_506_842_192_876_2),
        DVec3::new(-0.111_332_701_612_365_96, 0.015_356_730_643_134_562, -0.040_562_268_613_460_115),
    ];
    let mut input = input(
        camera(axes, sides),
        [0.642_172_757_232_471_9, -0.678_388_400_075_138_2, -0.356_936_028_598_877_4],
        [
            [-41.048_824_079_467_49, -0.494_955_143_177_835_07, -832.404_060_535_427_4],
            [32.786_256_999_493, 0.01, 837.734_886_986_553_1],
        ],
        [
            [-56_141.997_251_973_82, -350.495_857_480_434_15, -33_484.216_956_008_604],
            [56_135.223_071_113_62, 348.013_367_960_415, 33_488.720_499_308_87],
        ],
        512,
    );
    input.scene.visible_points = &seen;
    let caster = [-11.463_911_400_016_345, -0.116_689_064_939_639_04, 11.115_817_707_383_355];
    let frame = fit(Warp::LightSpacePerspective, true, &input);
    assert!(clip(&frame, caster).z >= 0.0, "{}", clip(&frame, caster));
}

/// An eye pulled back a thousand billion times the view cancelled to an infinite warp, and a mirrored map.
#[test]
fn an_eye_pulled_back_for_ever_is_uniform() {
    let axes = [
        [-0.534_886_207_360_136_6, 0.277_142_710_790_145_9, 0.798_178_340_367_476_3],
        [0.277_142_710_790_145_9, 0.949_958_451_788_935_3, -0.144_120_982_964_516_86],
        [-0.798_178_340_367_476_3, 0.144_120_982_964_516_86, -0.584_927_755_571_201_1],
    ];
    let sides = [
        -2.554_282_146_991_921,
        3.496_950_994_413_093,
        -2.374_439_171_118_016_4,
        2.374_439_171_118_016_4,
        2.561_609_400_512_436,
        f64::INFINITY,
    ];
    let travel = [-0.063_066_537_705_854_48, -0.502_763_231_188_048_2, -0.862_120_493_427_194_5];
    let input = input(
        camera(axes, sides),
        travel,
        [[-61.454_480_189_776_38, -96.931_821_364_367_2, -0.01], [0.01, 0.01, 624.581_443_207_155_3]],
        [
            [-60.586_847_780_468_76, -96.517_533_254_472_71, 622.577_085_305_900_8],
            [-60.469_055_806_982_57, -96.517_533_254_472_71, 622.577_085_305_900_8],
        ],
        64,
    );
    let frame = fit(Warp::Perspective { pull_back: 1e15 }, false, &input);
    assert!(frame.views[0].warp_strength < 1e-6, "{}", frame.views[0].warp_strength);
    let rows = [0, 1].map(|row| frame.views[0].clip_from_render.row(row).truncate().as_dvec3());
    assert!(rows[0].cross(rows[1]).dot(DVec3::from_array(travel)) < 0.0, "mirrored");
}

/// A strip of receivers that is narrower than its positions are uncertain was bent all the same, and lost.
#[test]
fn slivers_below_rounding_are_not_bent() {
    let axes = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];
    let sides = [
        -4.412_746_784_144_780_5,
        10.413_899_836_089_868,
        -3.214_865_438_559_836_5,
        3.214_865_438_559_836_5,
        2.513_104_120_525_874,
        f64::INFINITY,
    ];
    let input = input(
        camera(axes, sides),
        [1.593_412_283_577_343e-41, -1.0, 5.066_005_219_779_477e-42],
        [
            [177_675.295_073_996_6, -446_086.544_073_370_9, 194_099.420_981_291_13],
            [177_677.295_073_996_6, -446_084.544_073_370_9, 194_101.420_981_291_13],
        ],
        [
            [177_676.295_073_996_6, -446_087.544_073_370_9, 194_100.398_742_841_4],
            [177_676.295_073_996_6, -446_085.544_073_370_9, 194_100.443_219_740_85],
        ],
        16_384,
    );
    let frame = fit(Warp::Fixed { strength: 0.071_300_656 }, false, &input);
    let at = clip(&frame, [177_676.295_073_996_6, -446_085.544_073_370_9, 194_100.398_742_841_4]);
    assert!(is_inside(at), "{at}");
    assert_eq!(frame.views[0].warp_strength, 0.0);
}

/// The same: its window was thinner than f64 resolves, and culled what stood on its rim.
#[test]
fn casters_of_slivers_are_kept() {
    let axes = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
    let sides = [
        -5.095_232_006_065_224,
        2.971_764_132_980_844,
        -2.266_955_585_748_481,
        2.266_955_585_748_481,
        0.008_871_197_405_778_287,
        f64::INFINITY,
    ];
    let input = input(
        camera(axes, sides),
        [1.0, 0.0, 0.0],
        [
            [-1.099_448_196_573_608_7, -0.891_841_149_317_096_5, -0.880_633_443_050_631_4],
            [0.900_551_803_426_391_3, 1.108_158_850_682_903_7, 1.119_366_556_949_368_7],
        ],
        [
            [-0.101_743_561_904_666_44, 0.108_158_850_682_903_58, 0.119_366_556_949_368_62],
            [-0.083_422_219_118_998_83, 0.108_158_850_682_903_58, 0.119_366_556_949_368_62],
        ],
        1,
    );
    let frame = fit(Warp::Fixed { strength: 1.283_882_5e-5 }, false, &input);
    let caster = DVec3::new(-1.001_997_754_589_741_6, 0.108_158_850_682_903_58, 0.119_366_556_949_368_62);
    assert!(frame.views[0].cull.may_cast(&Aabb::new(caster, caster)));
}

/// Casters thousands of times farther away than the view is deep came to lie behind the centre of projection,
/// for want of digits.
#[test]
fn far_casters_stay_before_the_centre_of_projection() {
    let close = Camera::perspective(DMat4::IDENTITY, 1.0, 1.0, 0.01, 0.05);
    let travel = DVec3::new(0.31, -0.77, 0.55).normalize();
    let input = input(close, travel.to_array(), [[-5000.0; 3], [5000.0; 3]], [[-5000.0; 3], [5000.0; 3]], 16_384);
    let frame = fit(Warp::Fixed { strength: 1000.0 }, false, &input);
    for step in 0..=100 {
        for corner in 0..4 {
            let [x, y] = [1, 2].map(|bit| if corner & bit == 0 { -0.0054 } else { 0.0054 });
            let caster = DVec3::new(x, y, -0.01) - travel * f64::from(step) * 50.0;
            let at = clip(&frame, caster.to_array());
            assert!(at.w > 0.0, "{step}: {at}");
        }
    }
}

/// Methods with an axis of their own were guarded against a map without warp along *that* axis: the prediction of a
/// guarded map could be several times that of no warp.
#[test]
fn the_guard_measures_all_methods_alike() {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let everywhere = [[-5000.0; 3], [5000.0; 3]];
    for shift in [0.5, 2.0, 8.0] {
        let camera = camera(axes, [shift - 0.5, shift + 0.5, -0.5, 0.5, 0.1, 100.0]);
        let input = input(camera, [0.36, -0.8, 0.48], everywhere, everywhere, 1024);
        let none = fit(Warp::Fixed { strength: 0.0 }, false, &input).predicted.error;
        for focus in [0.0, 0.1, 0.3, 0.6, 1.0].map(Focus::Share) {
            let guarded = fit(Warp::Trapezoidal { focus }, true, &input).predicted.error;
            assert!(guarded <= none * 1.0001, "shift {shift}, {focus:?}: {guarded}, without {none}");
        }
    }
}

/// What f32 loses of places a thousand kilometres away is more than a near plane of a centimetre: the nearest slice
/// began behind the eye, no ray had any part of it, and its map went without a warp and without a word.
#[test]
fn nearest_slices_of_vast_views_are_warped() {
    let eye = DVec3::new(0.0, 2.0, 0.0);
    let fit = |near: f64| {
        let world_from_view = Camera::look_at(eye, DVec3::new(0.0, 1.8, -1.0), DVec3::Y);
        let camera = Camera::perspective(world_from_view, 1.0, 1.5, near, 1e6);
        let ground = [[-1e6, 0.0, -1e6], [1e6, 50.0, 1e6]];
        let input = FitInput {
            map: MapBudget { side: 1024, layers: 4, views: 4 },
            origin: eye,
            ..input(camera, [0.6, -0.8, 0.0], ground, ground, 1024)
        };
        techniques::cascades().fit(&input).unwrap()
    };
    let [near, far] = [0.01, 2.0].map(fit);
    let strengths = |frame: &ShadowFrame| frame.views.iter().map(|view| view.warp_strength).collect::<Vec<_>>();
    println!("near 0.01: {:?}, near 2: {:?}", strengths(&near), strengths(&far));
    assert!(far.views[0].warp_strength > 0.5 && near.views[0].warp_strength > 0.5);
}
