//! What takes part: every named technique, and every encoding that none of them has.

use antumbra::lab::experiment::Backend;
use antumbra::{
    DepthLaw, Encoding, MomentFormat, MomentKind, Moments, Pcf, Prefilter, Remix, SUN_ANGLE, Stabilise, Warp,
    techniques,
};

/// Sides of maps that all are drawn at, texels.
pub(crate) const SIZES: [u32; 3] = [512, 1024, 2048];

/// Sides at either end, for those of [`FEW`]: all of them there would take as long again as everything else.
const ENDS: [u32; 2] = [256, 4096];

/// Maps from this side on take most of the time: they get fewer turns, texels.
pub(crate) const LARGE: u32 = 2048;

/// Who is drawn at every size.
pub(crate) const FEW: [&str; 3] = ["fsm", "cascades", "smra-plus"];

/// The receiver that others are measured against: nine bilinear comparisons.
pub(crate) const NINE_TAPS: [&str; 2] = ["smra-plus pcf5x5", "fsm pcf5x5"];

/// A technique with an encoding.
#[derive(Clone, Debug)]
pub(crate) struct Contender {
    /// As rows name it.
    pub(crate) name: String,
    pub(crate) remix: Remix,
}

/// All of them, in the formats that the adapter has.
pub(crate) fn contenders(backend: &Backend) -> Vec<Contender> {
    let named = techniques::NAMED.iter().map(|(name, technique)| ((*name).to_owned(), technique()));
    // The filters of depth maps that no named technique has.
    let cascades = |pcf: Pcf| {
        (format!("cascades {}", pcf.name()), Remix { encoding: Encoding::Depth(pcf), ..techniques::cascades() })
    };
    let nine_taps = Remix { encoding: Encoding::Depth(Pcf::Box5x5), ..techniques::fsm() };
    let soft = Remix { encoding: Encoding::Soft { angle: SUN_ANGLE }, ..techniques::cascades() };
    let over_w = Remix { depth: DepthLaw::Projective, ..techniques::cascades() };
    let ours = Remix { encoding: Encoding::Depth(Pcf::Box5x5), ..techniques::smra_plus() };
    let depths = [cascades(Pcf::Box5x5), (NINE_TAPS[0].to_owned(), ours), (NINE_TAPS[1].to_owned(), nine_taps)]
        .into_iter()
        .chain([Pcf::Point, Pcf::Box3x3, Pcf::Box7x7, Pcf::Disc].map(cascades))
        .chain([("cascades pcss".to_owned(), soft), ("cascades depth/w".to_owned(), over_w)]);
    // What it costs that nothing crawls.
    let still = |name: &str, remix| {
        (format!("{name} snapped"), Remix { stabilise: Stabilise::SnapTexels, warp: Warp::Focused, ..remix })
    };
    let still = [still("fsm", techniques::fsm()), still("smra-plus", techniques::smra_plus())];
    let all = named.chain(depths).chain(still).chain(formats(backend));
    all.map(|(name, remix)| Contender { name, remix: backend.adapted(&remix) }).collect()
}

/// Kind and format of a remix's moments, if it has any.
fn moments(remix: &Remix) -> Option<(MomentKind, MomentFormat)> {
    match remix.encoding {
        Encoding::Moments(Prefilter { moments, .. }) => Some((moments.kind(), moments.format())),
        _ => None,
    }
}

/// Every kind of moments in every format that no named technique has, focused, by both names. Formats that the
/// adapter lacks are left out: they would be another contender once more.
fn formats(backend: &Backend) -> impl Iterator<Item = (String, Remix)> {
    let named: Vec<_> = techniques::NAMED.iter().filter_map(|(_, technique)| moments(&technique())).collect();
    let of_kind = |kind: MomentKind| kind.formats().iter().map(move |format| (kind, *format));
    let others = MomentKind::ALL.into_iter().flat_map(of_kind).filter(move |moments| !named.contains(moments));
    others.filter_map(|(kind, format)| {
        let prefilter = Prefilter::of(Moments::new(kind, format));
        let remix = Remix { encoding: Encoding::Moments(prefilter), ..techniques::fsm() };
        let has = moments(&backend.adapted(&remix)) == Some((kind, format));
        has.then(|| (format!("{} {}", kind.name(), format.name()), remix))
    })
}

/// Sizes that are drawn.
pub(crate) fn sizes(quick: bool) -> Vec<u32> {
    if quick { SIZES[..2].to_vec() } else { [&ENDS[..1], &SIZES, &ENDS[1..]].concat() }
}

/// Whether a contender is drawn at a size. Sums and series of large maps take
/// seconds on a software adapter.
pub(crate) fn takes_part(contender: &Contender, size: u32) -> bool {
    let slow = moments(&contender.remix)
        .is_some_and(|(kind, format)| format == MomentFormat::Summed || kind == MomentKind::Convolution);
    FEW.contains(&contender.name.as_str()) || SIZES.contains(&size) && !(slow && size >= LARGE)
}
