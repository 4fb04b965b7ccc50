//! The fragments of filters whose taps lie on a disc, and how the noise that turns it gets there.

use std::borrow::Cow;

use arrayvec::ArrayVec;

use crate::frame::{MapShape, Pcf, WgslKey};
use crate::texel::Texel;

/// The points of a disc.
pub(super) const POINTS: &str = include_str!("../../shaders/disc.wgsl");

/// `antumbra_visible` without noise.
pub(super) const VISIBLE_STEADY: &str = include_str!("../../shaders/visible_steady.wgsl");

/// `antumbra_visibility` without noise.
pub(super) const VISIBILITY_STEADY: &str = include_str!("../../shaders/visibility_steady.wgsl");

fn is_disc(key: WgslKey) -> bool {
    key.texel == Texel::Depth && key.filter.is_disc()
}

/// The text of a lookup's struct, with a member that says how taps are spread for filters that need it.
pub(super) fn map(key: WgslKey, text: &'static str) -> ArrayVec<Cow<'static, str>, 3> {
    const SLOPE: &str = "    slope: vec2f,\n";
    const SPREAD: &str = "    slope: vec2f,\n    // How taps are spread around it.\n    spread: AntumbraSpread,\n";
    if key.texel != Texel::Depth || !key.filter.is_spread() {
        return core::iter::once(text.into()).collect();
    }
    let mut fragments = ArrayVec::new();
    if key.filter == Pcf::Pixel {
        fragments.push(include_str!("../../shaders/pixel.wgsl").into());
    }
    fragments.push(spread(key).into());
    fragments.push(text.replacen(SLOPE, SPREAD, 1).into());
    fragments
}

fn spread(key: WgslKey) -> &'static str {
    match (key.filter, key.shape) {
        (Pcf::Pixel, MapShape::Affine) => include_str!("../../shaders/spread_pixel_affine.wgsl"),
        (Pcf::Pixel, _) => include_str!("../../shaders/spread_pixel_projective.wgsl"),
        (Pcf::Pcss, _) => include_str!("../../shaders/spread_soft.wgsl"),
        _ => include_str!("../../shaders/spread_disc.wgsl"),
    }
}

/// Where a receiver is looked up, with a turn of the disc.
pub(super) fn look(key: WgslKey) -> &'static str {
    match (key.shape, key.filter) {
        (MapShape::Affine, Pcf::Pcss) => include_str!("../../shaders/look_affine_soft.wgsl"),
        (_, Pcf::Pcss) => include_str!("../../shaders/look_projective_soft.wgsl"),
        (MapShape::Affine, _) => include_str!("../../shaders/look_affine_spread.wgsl"),
        _ => include_str!("../../shaders/look_projective_spread.wgsl"),
    }
}

/// A text that hands positions and normals on; for filters with a disc the same with noise, and what calls it without.
pub(super) fn noisy(key: WgslKey, text: &'static str, steady: &'static str) -> ArrayVec<Cow<'static, str>, 2> {
    const WITH_NOISE: [(&str, &str); 7] = [
        ("antumbra_look(", "antumbra_look_noisy("),
        ("antumbra_visible(", "antumbra_visible_noisy("),
        ("antumbra_visibility(", "antumbra_visibility_noisy("),
        (", normal)", ", normal, noise)"),
        (", view_depth)", ", view_depth, noise)"),
        ("normal: vec3f)", "normal: vec3f, noise: f32)"),
        ("view_depth: f32)", "view_depth: f32, noise: f32)"),
    ];
    if !is_disc(key) {
        return core::iter::once(over_pixel(key, text)).collect();
    }
    let text = WITH_NOISE.iter().fold(text.to_owned(), |text, (plain, noisy)| text.replace(plain, noisy));
    [text.into(), steady.into()].into()
}

/// A text whose lookups, once their map is found, are spread over the pixel, for the filter that follows it.
fn over_pixel(key: WgslKey, text: &'static str) -> Cow<'static, str> {
    const LOOKUPS: [(&str, &str); 3] = [
        (
            "antumbra_look(view, position, normal))",
            "antumbra_over_pixel(view, antumbra_look(view, position, normal), position,\n        antumbra_pixel(view, position, normal)))",
        ),
        (
            "antumbra_on_map(view, look)",
            "antumbra_on_map(view, antumbra_over_pixel(view, look, position,\n        antumbra_pixel(antumbra_uniforms.views[0], position, normal)))",
        ),
        (
            "antumbra_on_map(antumbra_uniforms.views[index], look)",
            "antumbra_on_map(antumbra_uniforms.views[index],\n                antumbra_over_pixel(antumbra_uniforms.views[index], look, position,\n                    antumbra_pixel(antumbra_uniforms.views[0], position, normal)))",
        ),
    ];
    if key.texel != Texel::Depth || key.filter != Pcf::Pixel {
        return text.into();
    }
    LOOKUPS.iter().fold(text.to_owned(), |text, (plain, over)| text.replace(plain, over)).into()
}
