//! Maps that share layers: drawn without touching each other, and read without reading each other.

use antumbra::gpu::{ShadowMaps, ShadowMapsDescriptor};
use antumbra::lab::cpu::{self, Visible};
use antumbra::lab::gpu::{RenderOptions, Renderer, read_depth};
use antumbra::lab::subject::{Setting, Subject};
use antumbra::{
    Camera, DepthLaw, DepthRange, DepthSplits, Encoding, FitInput, Light, MapBudget, Pcf, Remix, Scene, Select,
    ShadowFrame, ShadowTechnique, Share, Split, techniques,
};
use glam::DVec3;

use crate::{SIZE, Stage, support, wrong_in_the_interior};

/// Side of a layer, texels.
const SIDE: u32 = 1024;

/// Layers, for six maps.
const LAYERS: u32 = 2;

fn fit(stage: &Stage, camera: Camera, remix: &Remix) -> ShadowFrame {
    let scene = Scene::within(support::bounds(&stage.model));
    let light = Light::Directional { travel: support::travel() };
    let map = MapBudget { side: SIDE, layers: LAYERS, views: 8 };
    remix.fit(&FitInput { camera, light, scene, map, origin: stage.origin, previous: None }).unwrap()
}

fn draw(stage: &Stage, camera: Camera, frame: &ShadowFrame) -> (Vec<u8>, ShadowMaps) {
    let descriptor = ShadowMapsDescriptor { label: Some("tiles"), key: frame.wgsl, map: frame.map };
    let maps = ShadowMaps::new(stage.gpu.device(), &descriptor).unwrap();
    let renderer = Renderer::new(&stage.gpu, frame.wgsl);
    let image = renderer.render(&stage.gpu, &stage.scene, &camera, frame, &maps, &RenderOptions::default()).unwrap();
    (image.mask, maps)
}

fn remixes() -> impl Iterator<Item = Remix> {
    let ways = [(Select::Depth, 0.2), (Select::Finest, 0.0), (Select::Finest, 0.2)];
    ways.into_iter()
        .zip([Pcf::Hardware2x2, Pcf::Box5x5, Pcf::Point])
        .zip([DepthLaw::Linear, DepthLaw::Projective, DepthLaw::Linear])
        .map(|(((select, blend), filter), depth)| {
            let splits = DepthSplits { maps: 6, select, blend, enough: 0.0, ..DepthSplits::DEFAULT };
            let (split, encoding) = (Split::Depth(splits), Encoding::Depth(filter));
            Remix { split, encoding, depth, share: Share::LeastError, ..techniques::cascades() }
        })
}

/// Six maps in two layers are six maps in six layers: the same picture, bit by bit, and the software renderer's.
#[test]
fn tiles_are_maps() {
    let Some(stage) = Stage::new(DVec3::new(3.0, -2.0, 5.0)) else { return };
    let camera = support::camera(SIZE);
    let (light, subject) = (Light::Directional { travel: support::travel() }, Subject::new(stage.model.clone()));
    let setting = Setting { camera, light, visible: DepthRange { near: 0.0, far: 100.0 }, origin: stage.origin };
    let visible = Visible::draw(&stage.model, &camera, stage.origin);
    for remix in remixes() {
        let frame = fit(&stage, camera, &remix);
        assert!(frame.views.len() == 6 && frame.views.iter().all(|view| view.layer < LAYERS), "{:?}", frame.left_out);
        let mut apart = frame.clone();
        for index in 0..apart.views.len() {
            apart.views[index].layer = index as u32;
            apart.uniforms.views[index].across_u[3] = index as f32;
        }
        apart.map.layers = 6;
        let ((together, maps), (alone, _)) = (draw(&stage, camera, &frame), draw(&stage, camera, &apart));
        assert_eq!(maps.layers(), LAYERS);
        assert!(together == alone && together.contains(&0), "{remix:?}");
        // Away from edges it is the rays' picture: texels of tiles know their bias.
        let (wrong, counted) = wrong_in_the_interior(&stage.model, &camera, &together);
        eprintln!("{:?}: {wrong} of {counted} wrong", frame.wgsl);
        assert!(counted > 50_000 && wrong * 2_000 < counted, "{remix:?}: {wrong} of {counted}");
        let software = cpu::render(&subject, &visible, &frame, &setting).mask;
        let differ = together.iter().zip(&software).filter(|(gpu, cpu)| gpu.abs_diff(**cpu) > 16).count();
        assert!(differ * 500 < together.len(), "{remix:?}: {differ} pixels differ");
    }
}

/// A pass clears its own tile and its ring, and nothing else: what other maps of the layer hold stays.
#[test]
fn passes_leave_their_neighbours_alone() {
    let Some(stage) = Stage::new(DVec3::ZERO) else { return };
    let camera = support::camera(SIZE);
    for remix in remixes() {
        let frame = fit(&stage, camera, &remix);
        let (_, maps) = draw(&stage, camera, &frame);
        let read = |layer| read_depth(&stage.gpu, &maps, layer).unwrap();
        let before: Vec<Vec<f32>> = (0..LAYERS).map(read).collect();
        // Nothing is drawn this time.
        let view = frame.views.iter().find(|view| view.viewport.z < SIDE - 2).expect("a small map");
        let mut encoder =
            stage.gpu.device().create_command_encoder(&antumbra::gpu::wgpu::CommandEncoderDescriptor::default());
        drop(maps.caster_pass(&mut encoder, view, None));
        stage.gpu.queue().submit([encoder.finish()]);
        let (mut cleared, mut kept) = (0, 0);
        for (layer, before) in (0..LAYERS).zip(before) {
            for (texel, (now, before)) in read(layer).into_iter().zip(before).enumerate() {
                let [x, y] = [texel as u32 % SIDE, texel as u32 / SIDE];
                let at = view.viewport;
                let within = (at.x - 1..=at.x + at.z).contains(&x) && (at.y - 1..=at.y + at.w).contains(&y);
                if within && layer == view.layer {
                    assert_eq!(now, 1.0, "{x}, {y}");
                    cleared += usize::from(before < 1.0);
                } else {
                    assert_eq!(now.to_bits(), before.to_bits(), "{x}, {y} of layer {layer}");
                    kept += usize::from(now < 1.0 && layer == view.layer);
                }
            }
        }
        assert!(cleared > 100 && kept > 100, "{cleared} cleared, {kept} kept");
    }
}
