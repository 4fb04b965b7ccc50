//! Which of a frame's maps serves a point: the choice that the shaders make, for what measures maps one by one.

use glam::DVec3;

use crate::camera::Camera;
use crate::encoding::depth::antumbra_look;
use crate::encoding::split::{antumbra_index, antumbra_room};
use crate::frame::{MAX_VIEWS, Select, ShadowFrame};

/// The view of a frame that serves a point of a receiver with a normal, both in render space around `origin`.
///
/// One map serves everything. Of several, as the frame's key selects: the one whose depths hold the point's eye depth,
/// or the first one that holds the point and what its filter reads. Where two are blended, it is the nearer or the
/// finer one. `None` where no view serves it: there it reads lit.
#[must_use]
pub fn serving(frame: &ShadowFrame, camera: &Camera, origin: DVec3, position: DVec3, normal: DVec3) -> Option<usize> {
    let (key, views) = (frame.wgsl, frame.views.len());
    let last = usize::from(key.maps).clamp(1, MAX_VIEWS) - 1;
    let index = match key.select {
        _ if last == 0 => 0,
        Select::Depth => antumbra_index(&frame.uniforms, last, camera.eye_depth(position, origin) as f32),
        Select::Finest => {
            let (position, normal) = (position.as_vec3(), normal.as_vec3());
            let holds = |view| antumbra_room(view, &antumbra_look(key, view, position, normal)) >= 0.0;
            frame.uniforms.views[..views].iter().position(holds)?
        }
    };
    (index < views).then_some(index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encoding::depth::DepthMap;
    use crate::encoding::split::antumbra_visibility;
    use crate::frame::WgslKey;
    use crate::lab::bvh::Bvh;
    use crate::lab::case::Case;
    use crate::lab::cpu::Visible;
    use crate::lab::footprint::{COARSENESS, Measured};
    use crate::lab::oracle::{Compare, Oracle};
    use crate::lab::raster::Hit;
    use crate::lab::sparse_city::sparse_city;
    use crate::lab::subject::{Setting, Subject, case_of};
    use crate::lab::truth::Truth;
    use crate::lab::viewpoints::sparse_city_viewpoints;
    use crate::technique::ShadowTechnique;
    use crate::techniques;
    use glam::UVec2;

    const SIDE: u32 = 128;

    fn city() -> (Subject, Case, Setting) {
        let mut case = case_of(&sparse_city_viewpoints()[0], "sparse-city");
        case.viewport = [96, 72];
        let setting = Setting::of(&case);
        (Subject::new(sparse_city()), case, setting)
    }

    /// A map of what is near and a map of everything, and both in one frame.
    fn frames(
        subject: &Subject,
        setting: &Setting,
        visible: &Visible,
        select: Select,
    ) -> (ShadowFrame, ShadowFrame, ShadowFrame) {
        let technique = techniques::fsm();
        let mut depths: Vec<f64> =
            visible.iter().map(|hit| setting.camera.eye_depth(hit.position, setting.origin)).collect();
        depths.sort_by(f64::total_cmp);
        let middle = depths[depths.len() / 2];
        let [near, whole] = [middle, setting.visible.far].map(|far| {
            let mut setting = *setting;
            setting.visible.far = far;
            technique.fit(&setting.input(subject, &[], technique.wgsl_key(), SIDE)).expect("a legal case")
        });
        let mut both = near.clone();
        both.wgsl = WgslKey { maps: 3, select, ..near.wgsl };
        both.views.push(whole.views[0].clone());
        both.uniforms.views[0].domain = [0.0, middle as f32, 0.0, 0.0];
        both.uniforms.views[1] = whole.uniforms.views[0];
        both.uniforms.views[1].across_u[3] = 1.0;
        // The rest is in nobody's domain.
        both.uniforms.views[1].domain = [middle as f32, depths[depths.len() - depths.len() / 10] as f32, 0.0, 0.0];
        (near, whole, both)
    }

    /// The view that is named is the view that is read: of one map in shadow and one in light, one can tell.
    #[test]
    fn the_view_that_serves_is_the_one_that_is_read() {
        let (subject, _, setting) = city();
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        for select in Select::ALL {
            let (.., frame) = frames(&subject, &setting, &visible, select);
            // Nearer than any receiver, and farther than that of a view that is not in use.
            let (dark, light) = ([-0.9; 16], [2.0; 16]);
            let mut served = [0; 3];
            for Hit { position, normal, .. } in visible.iter().copied() {
                let view = serving(&frame, &setting.camera, setting.origin, position, normal);
                let eye_depth = setting.camera.eye_depth(position, setting.origin) as f32;
                let lit = [[&dark, &light], [&light, &dark]].map(|depths| {
                    let maps = depths.map(|depth| DepthMap { size: UVec2::splat(4), depth });
                    let (position, normal) = (position.as_vec3(), normal.as_vec3());
                    antumbra_visibility(frame.wgsl, &frame.uniforms, &maps, position, normal, eye_depth)
                });
                let expected = match view {
                    Some(0) => [0.0, 1.0],
                    Some(_) => [1.0, 0.0],
                    None => [1.0, 1.0],
                };
                assert_eq!(lit, expected, "{select:?}: {view:?} at {position}");
                served[view.unwrap_or(2)] += 1;
            }
            assert!(served[0] > 500 && served[1] > 500, "{select:?}: {served:?}");
            assert!(select == Select::Finest || served[2] > 100, "{select:?}: {served:?}");
        }
    }

    /// Footprints and the ideal lookup of several maps are, at each point, those of the map that serves it.
    #[test]
    fn what_is_measured_is_of_the_view_that_serves() {
        let (subject, case, setting) = city();
        let visible = Visible::draw(&subject.model, &setting.camera, setting.origin);
        let truth = Truth::trace(&case, &subject.model, &|| {});
        let bvh = Bvh::new(&subject.model);
        let oracle = Oracle::new(&case, &truth, &bvh).expect("directional light");
        let width = case.viewport[0] as usize;
        for select in Select::ALL {
            let (near, whole, both) = frames(&subject, &setting, &visible, select);
            let of = |frame: &ShadowFrame| {
                let painted = Measured::new(&visible, frame, &setting, &truth.valid).paint(width);
                (painted, oracle.mask(frame, setting.origin, Compare::Plane))
            };
            let (near, whole, both_of) = (of(&near), of(&whole), of(&both));
            assert!(near.0 != both_of.0 && whole.0 != both_of.0 && near.1 != both_of.1 && whole.1 != both_of.1);
            let coarse = width.div_ceil(COARSENESS);
            for (pixel, hit) in (0..truth.valid.len()).filter_map(|pixel| Some((pixel, visible.pixel(pixel)?))) {
                let serving = serving(&both, &setting.camera, setting.origin, hit.position, hit.normal);
                let Some(part) = serving.filter(|_| truth.valid[pixel]).map(|view| [&near, &whole][view]) else {
                    assert_eq!(both_of.1[pixel], 1.0, "{select:?}, pixel {pixel}");
                    continue;
                };
                assert_eq!(both_of.1[pixel], part.1[pixel], "{select:?}, pixel {pixel}");
                let (row, column) = (pixel / width, pixel % width);
                if row % COARSENESS == 0 && column % COARSENESS == 0 {
                    let at = 3 * (row / COARSENESS * coarse + column / COARSENESS);
                    assert_eq!(both_of.0[at..at + 3], part.0[at..at + 3], "{select:?}, pixel {pixel}");
                }
            }
        }
    }
}
