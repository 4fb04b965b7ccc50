//! The passes that filter a map.

use antumbra::transpile::Shader;
use antumbra::{Moments, SUMMED_TEXELS, wgsl};

#[test]
fn every_filter_is_a_shader() {
    for moments in Moments::all() {
        let text = wgsl::prefilter(moments);
        let shader = Shader::parse(&text).unwrap_or_else(|error| panic!("{moments:?}: {error}"));
        assert!(shader.spirv().is_ok() && shader.hlsl().is_ok() && shader.msl().is_ok(), "{moments:?}");
        let names: Vec<_> = shader.module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        let passes = if moments.is_summed() {
            ["antumbra_sum_depths", "antumbra_sum_along_u", "antumbra_sum_along_v"]
        } else {
            ["antumbra_blur_along_u", "antumbra_blur_along_v", "antumbra_halve"]
        };
        assert_eq!((names[0], &names[1..]), ("antumbra_everything", &passes[..]));
        let added = format!("const ANTUMBRA_SUMMED_TEXELS: i32 = {SUMMED_TEXELS};");
        assert_eq!(text.contains(&added), moments.is_summed());
    }
}
