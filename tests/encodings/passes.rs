//! The passes that filter a map.

use antumbra::transpile::Shader;
use antumbra::{Moments, wgsl};

#[test]
fn every_filter_is_a_shader() {
    for moments in Moments::all() {
        let text = wgsl::prefilter(moments);
        let shader = Shader::parse(&text).unwrap_or_else(|error| panic!("{moments:?}: {error}"));
        assert!(shader.spirv().is_ok() && shader.hlsl().is_ok() && shader.msl().is_ok(), "{moments:?}");
        let names: Vec<_> = shader.module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(names, ["antumbra_everything", "antumbra_blur_along_u", "antumbra_blur_along_v", "antumbra_halve"]);
    }
}
