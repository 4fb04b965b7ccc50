//! Texels that maps share: who gets how many, that they stay where they are, and that no lookup reads a neighbour's.

use antumbra::encoding::depth::DepthMap;
use antumbra::encoding::split::antumbra_visibility;
use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::sparse_city::sparse_city;
use antumbra::lab::subject::{Setting, Subject, case_of};
use antumbra::lab::viewpoints::sparse_city_viewpoints;
use antumbra::{
    Aabb, Camera, DepthSplits, Encoding, FitInput, Light, MapBudget, Part, Pcf, Remix, Scene, Scheme, Select,
    ShadowFrame, ShadowTechnique, Share, Split, Stabilise, Warp, Why, techniques,
};
use glam::{DVec3, UVec2, Vec3};

const SIDE: u32 = 512;

/// Layers of every budget here.
const LAYERS: u32 = 2;

fn remix(maps: u8, share: Share) -> Remix {
    let splits = DepthSplits { maps, enough: 0.0, ..DepthSplits::DEFAULT };
    Remix { split: Split::Depth(splits), share, ..techniques::cascades() }
}

/// A camera above ground, looking down by an angle (radians).
fn camera(down: f64) -> Camera {
    let eye = DVec3::new(0.0, 3.0, 0.0);
    let ahead = DVec3::new(0.0, -down.sin(), -down.cos());
    Camera::perspective(Camera::look_at(eye, eye + ahead, DVec3::Y), 1.0, 1.5, 0.5, 200.0)
}

fn fit(remix: &Remix, camera: Camera, previous: Option<&ShadowFrame>) -> ShadowFrame {
    // A road: what is far away is narrow.
    let scene = Scene::within(Aabb::new(DVec3::new(-8.0, -1.0, -300.0), DVec3::new(8.0, 4.0, 300.0)));
    let light = Light::Directional { travel: DVec3::new(0.5, -0.7, 0.4).normalize() };
    let map = MapBudget { side: SIDE, layers: LAYERS, views: 8 };
    remix.fit(&FitInput { camera, light, scene, map, origin: DVec3::ZERO, previous }).expect("legal")
}

/// Sides of a frame's maps: drawn texels and their ring.
fn sides(frame: &ShadowFrame) -> Vec<u32> {
    frame.views.iter().map(|view| view.viewport.z + 2).collect()
}

/// What is given away is what no one sees: every map's texels stay as fine, in the picture, as the worst one's, and
/// with one more halving they would not.
#[test]
fn equal_errors_are_equal() {
    let splits = DepthSplits { maps: 2, scheme: Scheme::Manual([10.0; 7]), enough: 0.0, ..DepthSplits::DEFAULT };
    let equal = Remix { split: Split::Depth(splits), warp: Warp::Focused, ..Remix::default() };
    let remix = Remix { share: Share::EqualError, ..equal };
    let (equal, shared) = (fit(&equal, camera(0.2), None), fit(&remix, camera(0.2), None));
    // What is seen lies in the middle of the depths.
    let errors = |frame: &ShadowFrame| {
        let error = |index: usize| {
            let [near, far, ..] = frame.uniforms.views[index].domain;
            frame.views[index].texel.pixels.error / (0.5 * (near + far))
        };
        [error(0), error(1)]
    };
    let (before, after) = (errors(&equal), errors(&shared));
    println!("{before:?} at {:?}, {after:?} at {:?}", sides(&equal), sides(&shared));
    assert_eq!(sides(&equal), [SIDE; 2]);
    assert!(sides(&shared)[1] < SIDE && sides(&shared)[0] == SIDE, "{:?}", sides(&shared));
    assert!(after[1] <= 1.15 * before[0] && after[1] >= before[0] / 2.5, "{before:?}, {after:?}");
    let why = Why::TexelsEnough { side: sides(&shared)[1] };
    assert!(shared.left_out.iter().any(|cut| cut.part == Part::Texels(1) && cut.why == why), "{:?}", shared.left_out);
}

/// More maps than layers: all are drawn, in texels that would have been one or two maps; none is left without.
#[test]
fn more_maps_than_layers() {
    for maps in 2..=8 {
        let equal = fit(&remix(maps, Share::Equal), camera(0.2), None);
        let least = fit(&remix(maps, Share::LeastError), camera(0.2), None);
        assert_eq!((equal.views.len(), least.views.len()), (2, usize::from(maps)), "{:?}", least.left_out);
        let texels: u32 = sides(&least).iter().map(|side| side * side).sum();
        println!("{maps} maps: {:?}, predicted {} for {}", sides(&least), least.predicted.error, equal.predicted.error);
        assert!(texels <= LAYERS * SIDE * SIDE);
        assert_eq!(maps > 2, least.left_out.iter().any(|cut| matches!(cut.why, Why::TexelsElsewhere { .. })));
    }
    // Texels for no more.
    let small = |share| {
        let scene = Scene::within(Aabb::new(DVec3::splat(-300.0), DVec3::splat(300.0)));
        let light = Light::Directional { travel: DVec3::NEG_Y };
        let map = MapBudget { side: 16, layers: 2, views: 8 };
        let filter = Encoding::Depth(Pcf::Box5x5);
        let input = FitInput { camera: camera(0.2), light, scene, map, origin: DVec3::ZERO, previous: None };
        Remix { encoding: filter, ..remix(5, share) }.fit(&input).expect("legal")
    };
    for share in [Share::EqualError, Share::LeastError] {
        let frame = small(share);
        let without = frame.left_out.iter().filter(|cut| cut.why == Why::NoMapLeft).count();
        assert!(
            without == 3 || frame.left_out.iter().any(|cut| matches!(cut.why, Why::MapTooSmall { .. })),
            "{frame:?}"
        );
    }
}

/// Whether two frames of equally many maps give them other sizes.
fn differ(one: &ShadowFrame, other: &ShadowFrame) -> bool {
    one.views.len() == other.views.len() && sides(one) != sides(other)
}

/// A map of the whole scene serves all slices behind its own, and gets the texels for that.
#[test]
fn a_map_of_the_whole_scene_takes_over() {
    let bounds = Aabb::new(DVec3::new(-40.0, -1.0, -40.0), DVec3::new(40.0, 4.0, 40.0));
    let light = Light::Directional { travel: DVec3::new(0.5, -0.7, 0.4).normalize() };
    let map = MapBudget { side: SIDE, layers: LAYERS, views: 8 };
    let scene = Scene::within(bounds);
    let input = FitInput { camera: camera(0.2), light, scene, map, origin: DVec3::ZERO, previous: None };
    let splits = DepthSplits {
        maps: 8,
        scheme: Scheme::Practical { lambda: 0.7, offset: 0.0 },
        enough: 0.0,
        ..DepthSplits::DEFAULT
    };
    let remix = Remix { split: Split::Depth(splits), stabilise: Stabilise::SnapTexels, ..remix(8, Share::LeastError) };
    let frame = remix.fit(&input).expect("legal");
    let last = frame.views.len() - 1;
    let served: Vec<u8> = frame
        .left_out
        .iter()
        .filter(|cut| cut.why == Why::ServedBy { view: last as u8 })
        .filter_map(|cut| if let Part::Split(split) = cut.part { Some(split) } else { None })
        .collect();
    println!("{:?}: {served:?}", sides(&frame));
    assert!(last > 0 && last < 7, "{:?}", frame.left_out);
    assert_eq!(served, (last as u8 + 1..8).collect::<Vec<_>>());
    assert_eq!(sides(&frame)[last], SIDE, "{:?}", frame.left_out);
    let lines = frame.left_out.iter().filter(|cut| cut.part == Part::Stabilise(last as u8)).count();
    assert_eq!(lines, 1, "what was taken back is not told twice");
}

/// Where sizes would change with every frame, they stay what they were in the frame before. Maps that stand still, cut
/// at depths that do, never change.
#[test]
fn sizes_do_not_flicker() {
    for (share, stabilise) in [
        (Share::EqualError, Stabilise::Off),
        (Share::LeastError, Stabilise::Off),
        (Share::LeastError, Stabilise::SnapTexels),
    ] {
        let still = stabilise == Stabilise::SnapTexels;
        let scheme = if still { Scheme::Practical { lambda: 0.7, offset: 0.0 } } else { Scheme::EqualError };
        let splits = DepthSplits { maps: 5, scheme, enough: 0.0, ..DepthSplits::DEFAULT };
        let remix = Remix { stabilise, split: Split::Depth(splits), ..remix(5, share) };
        let at = |step: u32| camera(f64::from(step) * 0.001);
        let halved = |step: &u32| sides(&fit(&remix, at(*step), None)).iter().any(|side| *side < SIDE);
        assert!((0..1400).any(|step| halved(&step)), "{share:?} {stabilise:?}");
        let changes: Vec<u32> =
            (0..1400).filter(|step| differ(&fit(&remix, at(*step), None), &fit(&remix, at(*step + 1), None))).collect();
        println!("{share:?} {stabilise:?}: {} changes", changes.len());
        assert_eq!(still, changes.is_empty(), "{changes:?}");
        for step in changes {
            // To and fro over the change, ten times.
            let (mut flips, mut before) = (0, fit(&remix, at(step), None));
            for frame in 1..20 {
                let next = fit(&remix, at(step + frame % 2), Some(&before));
                flips += usize::from(differ(&next, &before));
                before = next;
            }
            assert_eq!(flips, 0, "{share:?} at {step}");
        }
    }
}

/// Sizes that are wrong beyond doubt are given up, though later, and not more often.
#[test]
fn sizes_follow_in_the_end() {
    let remix = remix(5, Share::LeastError);
    let at = |step: u32| camera(f64::from(step) * 0.005);
    let (mut fresh, mut followed) = (0, 0);
    let mut before = fit(&remix, at(0), None);
    for step in 1..280 {
        let next = fit(&remix, at(step), Some(&before));
        followed += usize::from(differ(&next, &before));
        fresh += usize::from(differ(&fit(&remix, at(step), None), &fit(&remix, at(step - 1), None)));
        before = next;
    }
    println!("{followed} changes, {fresh} without history");
    assert!(followed > 0 && followed <= fresh);
    assert_eq!(sides(&fit(&remix, at(279), Some(&before))), sides(&before));
}

fn city() -> (Subject, Setting) {
    let mut case = case_of(&sparse_city_viewpoints()[0], "sparse-city");
    case.viewport = [320, 240];
    (Subject::new(sparse_city()), Setting::of(&case))
}

/// The same frame with every map in a layer of its own, where it was.
fn apart(frame: &ShadowFrame) -> ShadowFrame {
    let mut frame = frame.clone();
    for index in 0..frame.views.len() {
        frame.views[index].layer = index as u32;
        frame.uniforms.views[index].across_u[3] = index as f32;
    }
    frame.map.layers = frame.views.len() as u32;
    frame
}

/// Maps in one layer show what they show in layers of their own, bit by bit, with every filter and every way to find
/// them.
#[test]
fn neighbours_are_not_read() {
    let (subject, setting) = city();
    let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
    for (select, blend) in [(Select::Depth, 0.0), (Select::Depth, 0.2), (Select::Finest, 0.0), (Select::Finest, 0.2)] {
        for filter in Pcf::ALL {
            let splits = DepthSplits { maps: 6, select, blend, enough: 0.0, ..DepthSplits::DEFAULT };
            let (split, encoding) = (Split::Depth(splits), Encoding::Depth(filter));
            let remix = Remix { split, encoding, share: Share::LeastError, ..techniques::cascades() };
            let input = setting.input(&subject, &[], remix.wgsl_key(), 256);
            let map = MapBudget { layers: 2, ..input.map };
            let frame = remix.fit(&FitInput { map, ..input }).expect("legal");
            let packed = frame.views.iter().filter(|view| view.layer == frame.views[1].layer).count();
            assert!(frame.views.len() == 6 && packed > 1, "{:?}", frame.left_out);
            let [together, alone] =
                [&frame, &apart(&frame)].map(|frame| cpu::render(&subject, &visible, frame, &setting).mask);
            assert!(together == alone, "{select:?} {blend} {filter:?}");
            assert!(together.contains(&0) && together.contains(&255));
        }
    }
}

/// Nor do the composites by name read them, where their maps share texels.
#[test]
fn neighbours_of_composites_are_not_read() {
    let (subject, setting) = city();
    let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
    for technique in [techniques::smra(), techniques::smra_plus()] {
        let remix = Remix { share: Share::LeastError, ..technique };
        let input = setting.input(&subject, &[], remix.wgsl_key(), 256);
        let map = MapBudget { layers: 2, ..input.map };
        let frame = remix.fit(&FitInput { map, ..input }).expect("legal");
        let maps = usize::from(frame.wgsl.maps);
        assert!(frame.views.len() == maps && maps > 2, "{:?}", frame.left_out);
        let [together, alone] =
            [&frame, &apart(&frame)].map(|frame| cpu::render(&subject, &visible, frame, &setting).mask);
        assert!(together == alone, "{:?}", remix.encoding);
        assert!(together.contains(&0) && together.contains(&255));
    }
}

/// Wherever a receiver lies, and whatever its filter, one map of light among maps of darkness reads light beyond what
/// is drawn, if the texels around it are light.
#[test]
fn beyond_a_tile_is_light() {
    for filter in Pcf::ALL {
        let splits = DepthSplits { maps: 6, select: Select::Depth, enough: 0.0, ..DepthSplits::DEFAULT };
        let remix = Remix {
            split: Split::Depth(splits),
            encoding: Encoding::Depth(filter),
            share: Share::LeastError,
            ..techniques::cascades()
        };
        let frame = fit(&remix, camera(0.2), None);
        let side = SIDE as usize;
        let mut lit = 0;
        for (index, view) in frame.views.iter().enumerate() {
            // Everything dark but the ring of one tile.
            let mut layers = vec![vec![-2.0_f32; side * side]; LAYERS as usize];
            let [x, y, width, height] = view.viewport.to_array().map(|length| length as usize);
            for (row, depths) in layers[view.layer as usize].chunks_exact_mut(side).enumerate() {
                for (column, depth) in depths.iter_mut().enumerate() {
                    let within = (x - 1..=x + width).contains(&column) && (y - 1..=y + height).contains(&row);
                    let drawn = (x..x + width).contains(&column) && (y..y + height).contains(&row);
                    *depth = if within && !drawn { 2.0 } else { *depth };
                }
            }
            let maps: Vec<_> = layers.iter().map(|depth| DepthMap { size: UVec2::splat(SIDE), depth }).collect();
            let [near, far, ..] = frame.uniforms.views[index].domain;
            let depth = near + 0.5 * (far.min(1e4) - near);
            for step in 0..400_u32 {
                let angle = step as f32 * 0.1;
                let at = Vec3::new(angle.cos(), 0.0, angle.sin()) * (step as f32 * 3.0);
                let clip = view.clip_from_render * at.extend(1.0);
                let out = clip.truncate().truncate().abs().max_element() / clip.w;
                if clip.w > 0.0 && out > 1.0 + 16.0 / view.viewport.z as f32 {
                    let value = antumbra_visibility(frame.wgsl, &frame.uniforms, &maps, at, Vec3::ZERO, depth);
                    assert!((value - 1.0).abs() < 1e-6, "{filter:?}, view {index}: {value} at {at}");
                    lit += 1;
                }
            }
        }
        assert!(lit > 300, "{lit}");
    }
}

/// Shadows that end softly, whichever way maps are found: light comes over the last share of the last slice.
#[test]
fn shadows_fade_by_containment_as_well() {
    for (fade, expected) in [(true, [0.0, 0.5, 1.0]), (false, [0.0; 3])] {
        let splits = DepthSplits { maps: 3, blend: 0.2, fade, enough: 0.0, ..DepthSplits::DEFAULT };
        let remix = Remix { split: Split::Depth(splits), warp: Warp::Focused, ..Remix::default() };
        let eye = camera(0.0);
        let frame = fit(&remix, eye, None);
        let [near, far, ..] = frame.uniforms.views[frame.views.len() - 1].domain;
        let dark = vec![-2.0; (SIDE * SIDE) as usize];
        let maps: Vec<_> = (0..8).map(|_| DepthMap { size: UVec2::splat(SIDE), depth: &dark }).collect();
        let band = 0.2 * (far - near);
        for (depth, expected) in [far - 1.001 * band, far - 0.5 * band, far].into_iter().zip(expected) {
            let at = (eye.eye() + eye.forward() * f64::from(depth)).as_vec3();
            let lit = antumbra_visibility(frame.wgsl, &frame.uniforms, &maps, at, Vec3::Y, depth);
            assert!((lit - expected).abs() < 1e-3, "fade {fade}: {lit} at {depth} of {far}");
        }
    }
}
