//! Frames and cases: as engines have them, and hostile.

use antumbra::warp::{Focus, Warp};
use antumbra::{
    Aabb, Bias, DepthLaw, Encoding, FitInput, Light, MapBudget, MapShape, Remix, Scene, ShadowFrame, ShadowTechnique,
    ViewUniforms, WgslKey,
};
use glam::{DVec3, UVec2, Vec2, Vec3, Vec4};

use crate::dice::Dice;
use crate::{Case, support};

/// A frame over a box of ten units, automatic or manual; warped as a paper does, or by a strength that maps of some
/// thousand texels take, from hardly any on.
pub(crate) fn frame(dice: &mut Dice, key: WgslKey, side: u32, index: usize) -> ShadowFrame {
    let travel = (DVec3::new(0.0, -1.0, 0.0) + dice.vector(0.9).as_dvec3()).normalize();
    let bias = match index % 4 {
        3 if index % 8 == 3 => Bias::Manual { depth_world: 0.02, slope_texels: 0.0, normal_texels: 1.5 },
        3 => Bias::Manual { depth_world: 0.01, slope_texels: 2.5, normal_texels: 0.5 },
        _ => Bias::Automatic,
    };
    let warp = match (key.shape, index % 8) {
        (MapShape::Affine, _) => Warp::Focused,
        (_, 0) => Warp::LightSpacePerspective,
        (_, 1) => Warp::Trapezoidal { focus: Focus::default() },
        (_, 2) => Warp::Perspective { pull_back: 0.0 },
        (_, _) => Warp::Fixed { strength: 10.0_f32.powf(dice.single(-1.0, 2.5)) },
    };
    // The first frame is the map's own.
    let side = if key.shape != MapShape::Affine && index > 0 { 4096 } else { side };
    let bounds = Aabb::new(DVec3::splat(-5.0), DVec3::splat(5.0));
    let depth = match key.shape {
        MapShape::ProjectiveDepth => DepthLaw::Projective,
        MapShape::Affine | MapShape::Projective => DepthLaw::Linear,
    };
    Remix { encoding: Encoding::Depth(key.filter), bias, warp, depth, guard: false, ..Remix::default() }
        .fit(&FitInput {
            camera: support::camera(UVec2::new(640, 480)),
            light: Light::Directional { travel },
            scene: Scene::within(bounds),
            map: MapBudget::one(side),
            origin: DVec3::ZERO,
            previous: None,
        })
        .unwrap()
}

/// Depths, with both ends among them.
pub(crate) fn noise(dice: &mut Dice) -> f32 {
    match dice.below(16) {
        0 => 0.0,
        1 => 1.0,
        _ => dice.single(0.0, 1.0),
    }
}

/// Inputs as engines give them, and hostile ones.
pub(crate) fn case(dice: &mut Dice, frames: &[ShadowFrame], side: u32, depth: &[f32]) -> Case {
    let view = match dice.below(32) {
        0 => ViewUniforms::LIT,
        _ => frames[dice.below(frames.len())].uniforms.views[0],
    };
    let position = match dice.below(16) {
        0 => dice.vector(5_000.0),
        1 => dice.vector(12.0),
        // Near the plane through a warp's centre of projection (w = 0), on either side.
        2 | 3 => at_w(&view, dice.vector(5.0), dice.single(-3.0, 3.0)),
        _ => dice.vector(5.0),
    };
    let travel = Vec4::from_array(view.depth_from_render).truncate().normalize_or_zero();
    let unit = dice.vector(1.0).normalize_or(Vec3::Y);
    let normal = match dice.below(8) {
        0 => Vec3::ZERO,
        1 => -travel,
        // Grazing to within 1e-4, from both sides.
        2 => (travel.cross(unit) + travel * dice.single(-1e-4, 1e-4)).normalize_or(Vec3::X),
        3 => [Vec3::X, Vec3::NEG_Y, Vec3::Z][dice.below(3)],
        _ => unit,
    };
    let texel = |dice: &mut Dice| dice.below(side as usize) as f32;
    let place = |dice: &mut Dice| match dice.below(8) {
        // Edges and centres of texels, and far outside.
        0 => texel(dice) / side as f32,
        1 => (texel(dice) + 0.5) / side as f32,
        2 => dice.single(-4.0, 5.0),
        _ => dice.single(-0.2, 1.2),
    };
    let look_depth = match dice.below(8) {
        // Exactly what is stored somewhere, and beyond both ends.
        0 => depth[dice.below(depth.len())],
        1 => dice.single(-2.0, 3.0),
        _ => dice.single(0.0, 1.0),
    };
    let slope = Vec2::new(dice.single(-0.1, 0.1), dice.single(-0.1, 0.1));
    let offset = Vec2::new(dice.single(-3.0, 3.0), dice.single(-3.0, 3.0));
    Case {
        view,
        position: position.extend(1.0),
        normal: normal.extend(0.0),
        look: Vec4::new(place(dice), place(dice), look_depth, dice.single(0.0, 1.0)),
        slope_offset: Vec4::new(slope.x, slope.y, offset.x, offset.y),
        row: dice.vector(3.0).extend(dice.single(-3.0, 3.0)),
        weight: dice.vector(0.5).extend(0.0) + Vec4::ONE,
    }
}

/// A position moved to where w is a small number, of either sign; itself where w is the same everywhere.
fn at_w(view: &ViewUniforms, position: Vec3, near: f32) -> Vec3 {
    let row = Vec4::from_array(view.w_from_render);
    let gradient = row.truncate();
    if gradient == Vec3::ZERO {
        return position;
    }
    let w = near.signum() * 10.0_f32.powf(-2.0 * near.abs());
    position + gradient * ((w - row.dot(position.extend(1.0))) / gradient.length_squared())
}
