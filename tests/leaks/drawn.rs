//! A frame with its maps, depths or filtered moments, for lookups at any point and without rounding to eight bits.

use antumbra::encoding::depth::{CompareMap, DepthMap};
use antumbra::encoding::split::antumbra_visibility;
use antumbra::lab::moments::MomentMap;
use antumbra::lab::raster::{DepthMode, DepthTarget, RasterPass, rasterise};
use antumbra::lab::scene::SceneModel;
use antumbra::{FitInput, Remix, ShadowFrame, ShadowTechnique, Texel};
use glam::{DVec3, IVec2, UVec2, UVec4, Vec2, Vec3, Vec4};

/// A technique fitted to an input, drawn.
pub(crate) struct Drawn {
    pub(crate) frame: ShadowFrame,
    map: Layer,
}

impl Drawn {
    /// Draws all of a model into the one map of a technique.
    pub(crate) fn new(model: &SceneModel, input: &FitInput, remix: &Remix) -> Self {
        let frame = remix.fit(input).expect("a legal input");
        let depth = depths(model, &frame, input.origin);
        let map = match frame.wgsl.texel {
            Texel::Moments(moments) => {
                let mut map = MomentMap::new(moments, frame.map.side);
                map.filter(&depth, &frame.views[0]);
                map.halve();
                Layer::Moments(map)
            }
            Texel::Depth => Layer::Depth(frame.map.side, depth),
        };
        Self { frame, map }
    }

    /// Share of the light that reaches a point of render space.
    pub(crate) fn lit(&self, position: Vec3, normal: Vec3) -> f32 {
        let layers = std::slice::from_ref(&self.map);
        antumbra_visibility(self.frame.wgsl, &self.frame.uniforms, layers, position, normal, 0.0)
    }
}

/// A map that owns its texels.
enum Layer {
    Depth(u32, Vec<f32>),
    Moments(MomentMap),
}

impl CompareMap for Layer {
    fn size(&self) -> UVec2 {
        match self {
            Self::Depth(side, _) => UVec2::splat(*side),
            Self::Moments(map) => map.size(),
        }
    }

    fn sample_compare(&self, uv: Vec2, depth: f32) -> f32 {
        match self {
            Self::Depth(side, depths) => {
                DepthMap { size: UVec2::splat(*side), depth: depths }.sample_compare(uv, depth)
            }
            Self::Moments(map) => map.sample_compare(uv, depth),
        }
    }

    fn stored(&self, uv: Vec2, level: f32, pair: u32) -> Vec4 {
        match self {
            Self::Depth(..) => Vec4::ZERO,
            Self::Moments(map) => map.stored(uv, level, pair),
        }
    }

    fn sum(&self, texel: IVec2) -> UVec4 {
        match self {
            Self::Depth(..) => UVec4::ZERO,
            Self::Moments(map) => map.sum(texel),
        }
    }
}

/// What the first view of a frame sees, at its place in the layer.
fn depths(model: &SceneModel, frame: &ShadowFrame, origin: DVec3) -> Vec<f32> {
    let view = &frame.views[0];
    let [left, top, width, height] = view.viewport.to_array();
    let mut drawn = DepthTarget::new(width, height, DepthMode::LessEqual);
    let depth_from_render = frame.wgsl.shape.writes_depth().then_some(view.depth_from_render);
    let pass = RasterPass { clip_from_render: view.clip_from_render, depth_from_render, origin };
    rasterise(&mut drawn, model, &model.objects, &pass);
    let side = frame.map.side as usize;
    let mut map = vec![drawn.mode.cleared(); side * side];
    for (row, depths) in drawn.depth.chunks_exact(width as usize).enumerate() {
        let start = (top as usize + row) * side + left as usize;
        map[start..start + depths.len()].copy_from_slice(depths);
    }
    map
}
