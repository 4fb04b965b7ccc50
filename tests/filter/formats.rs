//! Every kind in every format: drawn, read, weighed.

use antumbra::encoding::depth::Lookup;
use antumbra::encoding::read::antumbra_filtered;
use antumbra::encoding::spread::Spread;
use antumbra::gpu::{self, ShadowMaps, ShadowMapsDescriptor, texture_format};
use antumbra::{MapBudget, MomentFormat, MomentKind, Moments, Radius, Remix, techniques};
use glam::{Vec2, Vec3};

use crate::stage::{Stage, encoding, filtered, fit, key_of};
use crate::support;

/// Mean difference that a format may make, of 255: MATH.md section 7's standard deviations of depth that rounding
/// makes, as shares of shadows' fringes; half floats keep variance a thousandth of the range squared apart, which is a
/// wide fringe at every contact.
fn allowed(moments: Moments) -> f64 {
    match (moments.kind(), moments.format()) {
        (_, MomentFormat::Float32) => 0.0,
        (MomentKind::Variance, MomentFormat::Float16) => 5.0,
        (_, MomentFormat::Float16) => 2.0,
        _ => 1.0,
    }
}

fn mean_difference(a: &[u8], b: &[u8]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
}

/// Each format draws the picture that 32 bits draw, as nearly as its steps allow; read by loads it is what samplers
/// read.
#[test]
fn formats_draw_one_picture() {
    let Some(stage) = Stage::new() else { return };
    let supported: Vec<_> = stage.supported().collect();
    let picture = |moments| {
        let remix = Remix { encoding: encoding(moments, Radius::Texels(1.5), false), ..techniques::fsm() };
        stage.picture(&fit(&remix, MapBudget::one(512)))
    };
    for kind in MomentKind::ALL {
        let exact = picture(Moments::new(kind, MomentFormat::Float32).read(kind == MomentKind::Convolution, false));
        for moments in supported.iter().filter(|moments| moments.kind() == kind && !moments.mips) {
            let other = picture(*moments);
            let mean = mean_difference(&exact, &other);
            let read = if moments.linear { "sampled" } else { "loaded" };
            println!("{} {}, {read}: mean difference {mean:.3} of 255", kind.name(), moments.format().name());
            // Samplers keep 8 bits of the place between texels: a 512th of a step from black to white.
            assert!(mean <= allowed(*moments) + 0.25, "{moments:?}: {mean}");
            assert!(other.iter().any(|lit| *lit < 60) && other.contains(&255), "{moments:?}");
        }
    }
}

/// Depths anywhere in the range come back from what a format keeps: in front of a plane is light, behind it is none, or
/// what its kind and format lose there.
#[test]
fn formats_hold_every_depth() {
    for moments in Moments::all().filter(|moments| !moments.mips) {
        let remix = Remix { encoding: encoding(moments, Radius::Texels(1.5), false), ..techniques::fsm() };
        let frame = fit(&remix, MapBudget::one(16));
        let (mut least_lit, mut most_dark) = (1.0_f32, 0.0_f32);
        for step in 0..=70 {
            let plane = step as f32 / 100.0;
            let map = filtered(moments, &frame, &[vec![plane; 16 * 16]]).remove(0);
            let lit = |depth| {
                let look = Lookup { uv: Vec2::splat(0.5), depth, slope: Vec2::ZERO, spread: Spread::default() };
                antumbra_filtered(frame.wgsl, &frame.uniforms.views[0], &map, &look, Vec3::ZERO)
            };
            least_lit = least_lit.min(lit((plane - 0.02).max(0.0)));
            most_dark = most_dark.max(lit(plane + 0.3));
        }
        println!(
            "{} {}: in front of planes at least {least_lit:.3}, behind them at most {most_dark:.3}",
            moments.kind().name(),
            moments.format().name()
        );
        assert!(least_lit > 0.95 && most_dark < 0.05, "{moments:?}: {least_lit} {most_dark}");
    }
}

/// Bytes as they are: of a texel, and of all textures of a map.
#[test]
fn bytes_are_counted() {
    let Some(gpu) = support::gpu() else { return };
    println!("kind, format: bytes per texel; a map of 1024: moments, with mips; all with depth and scratch, MiB");
    let mut largest = 0;
    for moments in Moments::all().filter(|moments| !moments.linear || moments.format() != MomentFormat::Float32) {
        if !gpu.device().features().contains(gpu::required_features(key_of(moments))) {
            continue;
        }
        let map = MapBudget::one(1024);
        let descriptor = ShadowMapsDescriptor { label: None, key: key_of(moments), map };
        let maps = ShadowMaps::new(gpu.device(), &descriptor).unwrap();
        let texture = maps.moments_texture().unwrap();
        let texel = texture_format(moments).block_copy_size(None).unwrap();
        assert_eq!((texture.format(), texel * moments.layers()), (texture_format(moments), moments.bytes()));
        // Texel by texel, level by level.
        let levels = (0..texture.mip_level_count()).map(|level| u64::from(1024_u32 >> level).pow(2)).sum::<u64>();
        let stored = levels * u64::from(texture.depth_or_array_layers() * texel);
        let scratch = u64::from(1024 * 1024 * texel);
        assert_eq!(maps.bytes(), stored + scratch + 1024 * 1024 * 4, "{moments:?}");
        largest = largest.max(maps.bytes());
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        println!(
            "{} {}, mips {}: {} bytes; {:.2}; {:.2}",
            moments.kind().name(),
            moments.format().name(),
            moments.mips,
            moments.bytes(),
            mib(stored),
            mib(maps.bytes())
        );
    }
    assert!(largest > 0);
}
