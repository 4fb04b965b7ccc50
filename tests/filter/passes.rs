//! The passes against their twin in memory, texel by texel, level by level.

use antumbra::encoding::blur::{antumbra_blur_reach, antumbra_blur_weight};
use antumbra::encoding::read::antumbra_store;
use antumbra::gpu::ShadowMaps;
use antumbra::lab::gpu::{Renderer, read_depth, read_moments};
use antumbra::{MapBudget, MapShape, MomentKind, Moments, Radius, Remix, ShadowFrame, techniques};
use glam::Vec4;

use crate::bound::{bound, differs, largest_within, texels};
use crate::stage::{Stage, encoding, fit, tiled, with_levels};

/// Side of a layer, texels.
const SIDE: u32 = 128;

/// Most texels that a blur reads to either side, rounded up.
const REACH: usize = 48;

/// Half-widths: none, the default, some, the most, and one of the world (boxes are 2 wide).
const RADII: [Radius; 5] =
    [Radius::Texels(0.0), Radius::Texels(1.5), Radius::Texels(7.0), Radius::Texels(32.0), Radius::World(0.6)];

/// Compares every texel of every level; gives back the largest difference as a share of what it may be.
fn compare(stage: &Stage, moments: Moments, frame: &ShadowFrame, maps: &ShadowMaps) -> f32 {
    let mut worst = 0.0_f32;
    let memory = stage.in_memory(moments, frame, maps);
    for (layer, map) in memory.iter().enumerate() {
        let depths = read_depth(&stage.gpu, maps, layer as u32).unwrap();
        for pair in 0..moments.layers() {
            let stored: Vec<Vec4> =
                depths.iter().map(|depth| antumbra_store(moments, *depth, 2 * pair).abs()).collect();
            // Of bent depths the largest in sight counts; all others lie within 1.
            let mut largest = match moments.kind() {
                MomentKind::Exponential | MomentKind::ExponentialVarianceTwo | MomentKind::ExponentialVarianceFour => {
                    largest_within(&stored, SIDE as usize, REACH)
                }
                _ => vec![Vec4::ONE; stored.len()],
            };
            for level in 0..=moments.last_level(SIDE) {
                let side = (SIDE >> level) as usize;
                if level > 0 {
                    largest = halved(&largest, side);
                }
                let gpu = read_moments(&stage.gpu, maps, layer as u32 * moments.layers() + pair, level).unwrap();
                let cpu = texels(map, pair as usize, level as usize, side);
                assert_eq!(gpu.len(), cpu.len());
                let drawn = |index: usize| is_drawn(frame, layer as u32, index, level);
                for index in (0..gpu.len()).filter(|index| drawn(*index)) {
                    let share = share(moments, level, [gpu[index], cpu[index]], largest[index]);
                    assert!(
                        share <= 1.0,
                        "{moments:?}, layer {layer}, terms {pair}, level {level}, texel {index}: {} on the GPU, {} in \
                         memory: {share} times what is allowed",
                        gpu[index],
                        cpu[index]
                    );
                    worst = worst.max(share);
                }
            }
        }
    }
    worst
}

/// Difference of two texels, as a share of what it may be.
fn share(moments: Moments, level: u32, [gpu, cpu]: [Vec4; 2], largest: Vec4) -> f32 {
    if moments.kind() == MomentKind::Exponential {
        return differs(moments, level, [gpu.x, cpu.x], largest.x);
    }
    let bound = bound(moments, level, largest);
    let channels = moments.kind().channels().min(4) as usize;
    (0..channels)
        .map(|channel| (gpu[channel] - cpu[channel]).abs() / bound[channel])
        .fold(0.0, |worst, share| if share.is_nan() { f32::INFINITY } else { worst.max(share) })
}

fn halved(values: &[Vec4], side: usize) -> Vec<Vec4> {
    let at =
        |index: usize, dx: usize, dy: usize| values[(2 * (index / side) + dy) * 2 * side + 2 * (index % side) + dx];
    (0..side * side)
        .map(|index| at(index, 0, 0).max(at(index, 1, 0)).max(at(index, 0, 1)).max(at(index, 1, 1)))
        .collect()
}

/// Whether a texel belongs to a view: what lies between tiles was never written.
fn is_drawn(frame: &ShadowFrame, layer: u32, index: usize, level: u32) -> bool {
    let side = SIDE as usize >> level;
    let [x, y] = [index % side, index / side].map(|at| (at as u32) << level);
    frame.views.iter().filter(|view| view.layer == layer).any(|view| {
        let [left, top, tile, _] = view.blur.tile;
        let within = |at: u32, start: u32| at >= start && at + (1 << level) <= start + tile;
        within(x, left) && within(y, top)
    })
}

/// One map, uniform and warped by two rules: every format that holds every kind, with boxes and bells of every
/// half-width; and every other way to read them with one.
#[test]
fn passes_agree_with_memory() {
    let Some(stage) = Stage::new() else { return };
    let all: Vec<Moments> = stage.supported().collect();
    let map = MapBudget::one(SIDE);
    let mut formats: Vec<Moments> = Vec::new();
    for moments in all.iter().filter(|moments| moments.mips) {
        if !formats.iter().any(|other| (other.kind(), other.format()) == (moments.kind(), moments.format())) {
            formats.push(*moments);
        }
    }
    for moments in &formats {
        let mut worst = [0.0_f32; 3];
        let bent: [fn() -> Remix; 3] = [techniques::fsm, techniques::tsm, techniques::lispsm];
        for (technique, worst) in bent.into_iter().zip(&mut worst) {
            let remix = |radius, bell| Remix { encoding: encoding(*moments, radius, bell), ..technique() };
            let first = fit(&remix(RADII[0], false), map);
            let (maps, renderer) = (stage.maps(&first), Renderer::new(&stage.gpu, first.wgsl));
            for radius in RADII {
                for bell in [false, true] {
                    let frame = with_levels(*moments, fit(&Remix { guard: false, ..remix(radius, bell) }, map));
                    let bent = frame.wgsl.shape != MapShape::Affine;
                    assert_eq!(frame.views[0].warp_strength > 0.1, bent, "{}", frame.views[0].warp_strength);
                    stage.draw(&renderer, &frame, &maps);
                    *worst = worst.max(compare(&stage, *moments, &frame, &maps));
                }
            }
        }
        println!("{} {}: {worst:.3?} of the bound (fsm, tsm, lispsm)", moments.kind().name(), moments.format().name());
    }
    // Sums are integers, and are compared as such (summed.rs).
    for moments in all.into_iter().filter(|moments| !formats.contains(moments) && !moments.is_summed()) {
        let remix = Remix { encoding: encoding(moments, RADII[1], false), ..techniques::fsm() };
        let frame = with_levels(moments, fit(&remix, map));
        let maps = stage.maps(&frame);
        stage.draw(&Renderer::new(&stage.gpu, frame.wgsl), &frame, &maps);
        compare(&stage, moments, &frame, &maps);
    }
    assert!(formats.len() >= 10, "{}", formats.len());
}

/// Six warped maps of different sizes in two layers.
#[test]
fn passes_agree_in_tiles() {
    let Some(stage) = Stage::new() else { return };
    for moments in stage.supported().filter(|moments| moments.mips && moments.linear == (moments.format().bits() != 32))
    {
        let mut worst = 0.0_f32;
        for (radius, bell) in [(Radius::Texels(1.5), false), (Radius::World(0.3), true)] {
            let (remix, map) = tiled(encoding(moments, radius, bell), SIDE);
            let frame = with_levels(moments, fit(&remix, map));
            let small = frame.views.iter().filter(|view| view.blur.tile[2] < SIDE).count();
            assert!(frame.views.len() >= 4 && small >= 3, "{:?}", frame.left_out);
            let maps = stage.maps(&frame);
            stage.draw(&Renderer::new(&stage.gpu, frame.wgsl), &frame, &maps);
            worst = worst.max(compare(&stage, moments, &frame, &maps));
        }
        println!("tiles, {} {}: {worst:.3} of the bound", moments.kind().name(), moments.format().name());
    }
}

/// Weights follow the radius without a jump, which would show as an edge where a world radius changes over a map, and
/// as a difference between adapters that round it differently.
#[test]
fn weights_are_continuous() {
    for bell in [false, true] {
        let weights = |radius: f32| -> Vec<f32> {
            let reach = antumbra_blur_reach(radius, bell);
            let weight = |offset: i32| {
                if offset.abs() > reach { 0.0 } else { antumbra_blur_weight(offset as f32, radius, bell) }
            };
            let all: Vec<f32> = (-48..=48).map(weight).collect();
            let whole: f32 = all.iter().sum();
            assert!(all.iter().all(|weight| (0.0..=1.0).contains(weight)) && whole >= 0.5, "{radius}");
            all.iter().map(|weight| weight / whole).collect()
        };
        let step = 1.0 / 1024.0;
        let mut before = weights(0.0);
        assert_eq!(before[48], 1.0);
        for index in 1..=32 * 1024 {
            let radius = index as f32 * step;
            let now = weights(radius);
            let jump = before.iter().zip(&now).map(|(before, now)| (before - now).abs()).fold(0.0, f32::max);
            // A texel that comes in takes as much from the middle one, twice: 2 dr at most, and 3/r² of the bell's
            // rise.
            assert!(jump <= 4.0 * step, "radius {radius}, bell {bell}: {}", jump / step);
            // Box and bell deviate alike, from where texels do not decide about it.
            if radius > 3.0 {
                let variance: f32 = now.iter().zip(-48..).map(|(weight, at)| weight * (at * at) as f32).sum();
                let ratio = variance.sqrt() / (radius / 3.0_f32.sqrt());
                assert!((0.85..1.1).contains(&ratio), "radius {radius}, bell {bell}: {ratio}");
            }
            before = now;
        }
    }
}
