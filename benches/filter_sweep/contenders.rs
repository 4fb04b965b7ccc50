//! What takes part, and the memory that it takes.

use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor, supported};
use antumbra::lab::gpu::Gpu;
use antumbra::{
    Encoding, MapBudget, MomentFormat, MomentKind, Moments, Pcf, Prefilter, Radius, Remix, ShadowTechnique, techniques,
};

use crate::SIDE;

/// Name of the yardstick.
pub(crate) const PCF: &str = "PCF";

/// A way to filter.
pub(crate) struct Contender {
    pub(crate) name: String,
    pub(crate) remix: Remix,
    /// Bilinear taps to an axis, for what compares first.
    pub(crate) taps: Option<u32>,
}

/// Moments that take part: each kind in 32 bits, those that 16 bits hold well, and sums.
fn kinds(gpu: &Gpu) -> Vec<Moments> {
    use MomentFormat::{Float16, Float32, Summed, Unorm16};
    let small = [
        (MomentKind::ExponentialVarianceFour, Float16),
        (MomentKind::Hamburger, Unorm16),
        (MomentKind::Variance, Summed),
        (MomentKind::Hamburger, Summed),
    ];
    let all = MomentKind::ALL.into_iter().map(|kind| (kind, Float32)).chain(small);
    all.map(|(kind, format)| supported(Moments::new(kind, format), gpu.device().features())).collect()
}

fn name(moments: Moments) -> String {
    format!("{} {}", moments.kind().name(), moments.format().name())
}

/// All of them at a width in texels; the yardstick first.
pub(crate) fn of_width(gpu: &Gpu, width: u32) -> Vec<Contender> {
    let focused = |encoding| Remix { encoding, ..techniques::fsm() };
    let (taps, filter) = if width == 3 { (None, Pcf::Box3x3) } else { (Some(width.div_ceil(2)), Pcf::Box5x5) };
    // The library's own box has no loop.
    let taps = taps.filter(|taps| *taps != 3);
    let mut all = vec![Contender { name: PCF.to_owned(), remix: focused(Encoding::Depth(filter)), taps }];
    for moments in kinds(gpu) {
        let radius = Radius::Texels(0.5 * width as f32);
        let remix = focused(Encoding::Moments(Prefilter { radius, ..Prefilter::of(moments) }));
        all.push(Contender { name: name(moments), remix, taps: None });
    }
    all
}

/// Bytes of one map and everything that fills it.
pub(crate) struct Memory {
    pub(crate) name: String,
    pub(crate) texel: u32,
    /// Without and with mips.
    pub(crate) bytes: [u64; 2],
}

/// Memory of every encoding that the adapter holds.
pub(crate) fn memory(gpu: &Gpu) -> Result<Vec<Memory>, String> {
    let bytes = |encoding| -> Result<u64, String> {
        let key = Remix { encoding, ..techniques::fsm() }.wgsl_key();
        let descriptor = ShadowMapsDescriptor { label: None, key, map: MapBudget::one(SIDE) };
        ShadowMaps::new(gpu.device(), &descriptor).map(|maps| maps.bytes()).map_err(|error| error.to_string())
    };
    let depth = bytes(Encoding::default())?;
    let mut all = vec![Memory { name: "depth f32".to_owned(), texel: 4, bytes: [depth; 2] }];
    for kind in MomentKind::ALL {
        for format in kind.formats() {
            let moments = Moments::new(kind, *format);
            if supported(moments, gpu.device().features()).format() != *format {
                continue;
            }
            let moments = supported(moments, gpu.device().features());
            let of = |mips| bytes(Encoding::Moments(Prefilter::of(moments.read(moments.linear, mips))));
            all.push(Memory { name: name(moments), texel: moments.bytes(), bytes: [of(false)?, of(true)?] });
        }
    }
    Ok(all)
}
