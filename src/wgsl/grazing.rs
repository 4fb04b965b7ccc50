//! The fragments of the rule for grazing light, and how it comes before a key's lookup.

use std::borrow::Cow;

use arrayvec::ArrayVec;

use super::disc;
use crate::frame::WgslKey;
use crate::grazing::Grazing;

/// How much of a visibility the light's angle decides.
pub(super) fn rule(grazing: Grazing) -> Option<Cow<'static, str>> {
    match grazing {
        Grazing::Off => None,
        Grazing::Printed => Some(include_str!("../../shaders/grazing_printed.wgsl").into()),
        Grazing::Continuous => Some(include_str!("../../shaders/grazing_continuous.wgsl").into()),
    }
}

/// What an engine calls: the lookup itself, or with a rule its own function, and the rule before it.
pub(super) fn called(key: WgslKey, lookup: &'static str) -> ArrayVec<Cow<'static, str>, 3> {
    const GRAZED: &str = include_str!("../../shaders/visibility_grazed.wgsl");
    let whole = |text| disc::noisy(key, text, disc::VISIBILITY_STEADY);
    if key.grazing == Grazing::Off {
        return whole(lookup).into_iter().collect();
    }
    let renamed = |text: Cow<str>| {
        ["fn antumbra_visibility_noisy(", "fn antumbra_visibility("]
            .iter()
            .fold(text.into_owned(), |text, name| text.replace(name, "fn antumbra_mapped("))
    };
    // All views are of one light.
    let view = if key.maps > 1 { "antumbra_uniforms.views[0]." } else { "antumbra_uniforms.view." };
    let seen = |text: Cow<str>| text.replace("antumbra_uniforms.view.", view);
    let mapped = whole(lookup).into_iter().take(1).map(renamed);
    mapped.chain(whole(GRAZED).into_iter().map(seen)).map(Cow::Owned).collect()
}
