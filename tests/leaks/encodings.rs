//! The encodings that are measured.

use antumbra::{Encoding, MomentFormat, MomentKind, Moments, Prefilter, Radius};

/// Moments of a kind and a format, averaged over a box of so many texels to either side.
pub(crate) fn moments(kind: MomentKind, format: MomentFormat, radius: f32, dark: f32) -> Encoding {
    let moments = Moments::new(kind, format);
    Encoding::Moments(Prefilter { radius: Radius::Texels(radius), dark, ..Prefilter::of(moments) })
}

/// Every kind in every format that holds it, by name.
pub(crate) fn formats() -> impl Iterator<Item = (String, MomentKind, MomentFormat)> {
    let of_kind = |kind: MomentKind| kind.formats().iter().map(move |format| (kind, *format));
    MomentKind::ALL
        .into_iter()
        .flat_map(of_kind)
        .map(|(kind, format)| (format!("{} {}", kind.name(), format.name()), kind, format))
}
