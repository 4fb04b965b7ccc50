//! What is photographed: a scene as the library sees it (bounds and objects), and a setting of camera and light.

use std::path::Path;

use glam::DVec3;

use super::case::{Case, CaseLight, SceneSource};
use super::cpu::Visible;
use super::gltf::{LoadError, load};
use super::scene::SceneModel;
use super::sparse_city::sparse_city;
use super::treeline::treeline;
use super::viewpoints::Viewpoint;
use crate::camera::Camera;
use crate::frame::WgslKey;
use crate::light::Light;
use crate::scene::{Aabb, DepthRange, MapBudget, Object, Scene};
use crate::technique::FitInput;

/// A scene with the bounds an engine would know.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The triangles.
    pub model: SceneModel,
    /// One per range of `model.objects`.
    pub objects: Vec<Object>,
    /// Around everything.
    pub bounds: Aabb,
}

impl Subject {
    /// Finds the bounds of a scene and its objects.
    #[must_use]
    pub fn new(model: SceneModel) -> Self {
        let bounds_of = |triangles: std::ops::Range<usize>| {
            Aabb::around(model.triangles[triangles].iter().flatten().map(|&index| model.positions[index as usize]))
        };
        let objects: Vec<Object> =
            model.objects.iter().map(|range| Object { bounds: bounds_of(range.clone()), casts: true }).collect();
        let bounds = objects.iter().fold(Aabb::EMPTY, |all, object| all.union(object.bounds));
        Self { model, objects, bounds }
    }

    /// What is left of it as a caster where front faces are culled: triangles that are turned away from a directional
    /// light, as `Face::Front` and counter-clockwise front faces leave them. Objects keep their bounds, so that frames
    /// are the same. Closed solids alone still cast whole shadows; ground and leaves cast none, or half.
    #[must_use]
    pub fn back_faces(&self, travel: DVec3) -> Self {
        let model = &self.model;
        let mut left = SceneModel { triangles: Vec::new(), triangle_cutout: Vec::new(), ..model.clone() };
        for (object, range) in left.objects.iter_mut().zip(&model.objects) {
            let start = left.triangles.len();
            for triangle in range.clone() {
                let [a, b, c] = model.corners(triangle);
                if (b - a).cross(c - a).dot(travel) > 0.0 {
                    left.triangles.push(model.triangles[triangle]);
                    left.triangle_cutout.extend(model.triangle_cutout.get(triangle));
                }
            }
            *object = start..left.triangles.len();
        }
        Self { model: left, ..self.clone() }
    }

    /// The scene of a case: built in, or from a file.
    ///
    /// # Errors
    /// [`LoadError`] naming the file.
    pub fn load(source: &SceneSource) -> Result<Self, LoadError> {
        Ok(Self::new(match source {
            SceneSource::BuiltIn(name) if name == "treeline" => treeline(),
            SceneSource::BuiltIn(_) => sparse_city(),
            SceneSource::File(path) => load(path)?,
        }))
    }

    /// The scene of a file.
    ///
    /// # Errors
    /// [`LoadError`] naming the file.
    pub fn load_file(path: &Path) -> Result<Self, LoadError> {
        load(path).map(Self::new)
    }
}

/// A camera and a light, as the library wants them. Render space has its origin at the eye.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// The camera; its viewport is the size of the picture.
    pub camera: Camera,
    /// The light.
    pub light: Light,
    /// The eye depths in which shadows are wanted.
    pub visible: DepthRange,
    /// Origin of render space.
    pub origin: DVec3,
}

impl Setting {
    /// The setting of a case.
    #[must_use]
    pub fn of(case: &Case) -> Self {
        let [width, height] = case.viewport;
        let aspect = f64::from(width) / f64::from(height);
        let fov_y = case.camera.fov_y_deg.to_radians();
        let mut camera = Camera::perspective(case.world_from_view(), fov_y, aspect, case.camera.near, case.camera.far);
        camera.viewport = glam::UVec2::new(width, height);
        let visible = DepthRange { near: case.camera.near, far: case.shadow_distance.max(case.camera.near) };
        Self { camera, light: light_of(&case.light), visible, origin: case.camera.eye }
    }

    /// Surfaces that are seen and face the light, as an engine reads them out of last frame's depth buffer: one for
    /// each cell of [`SEEN_GRID`], within the shadow distance.
    #[must_use]
    pub fn visible_points(&self, subject: &Subject) -> Vec<DVec3> {
        let Light::Directional { travel } = self.light else { return Vec::new() };
        let mut camera = self.camera;
        camera.viewport = SEEN_GRID;
        let hits = Visible::draw(&subject.model, &camera, self.origin);
        hits.iter()
            .filter(|hit| hit.normal.dot(travel) < 0.0)
            .filter(|hit| camera.eye_depth(hit.position, self.origin) <= self.visible.far)
            .map(|hit| hit.position + self.origin)
            .collect()
    }

    /// The eye depths of everything that is seen within the shadow distance, as an engine reduces last frame's depth
    /// buffer: exact at pixel centres, and a thousandth wider.
    #[must_use]
    pub fn visible_range(&self, subject: &Subject) -> DepthRange {
        let hits = Visible::draw(&subject.model, &self.camera, self.origin);
        let depths = hits.iter().map(|hit| self.camera.eye_depth(hit.position, self.origin));
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (near, far) = depths.fold(none, |(near, far), depth| (near.min(depth), far.max(depth)));
        let DepthRange { near: nearest, far: farthest } = self.visible;
        let (near, far) = ((near * (1.0 - ROOM)).max(nearest), (far * (1.0 + ROOM)).min(farthest));
        if near <= far { DepthRange { near, far } } else { self.visible }
    }

    /// What a technique is given for `subject`, what is `seen` of it, and as many maps of `side × side` texels as its
    /// shader `key` ([`ShadowTechnique::wgsl_key`](crate::ShadowTechnique::wgsl_key)) has.
    #[must_use]
    pub fn input<'a>(&self, subject: &'a Subject, seen: &'a [DVec3], key: WgslKey, side: u32) -> FitInput<'a> {
        let maps = u32::from(key.maps).max(1);
        FitInput {
            camera: self.camera,
            light: self.light,
            scene: Scene {
                casters: subject.bounds,
                receivers: subject.bounds,
                objects: &subject.objects,
                visible_depth: Some(self.visible),
                visible_points: seen,
            },
            map: MapBudget { side, layers: maps, views: maps },
            origin: self.origin,
            previous: None,
        }
    }
}

/// By how much ranges of depth are wider than what is seen, as a share: what f32 and a rasteriser may lose.
const ROOM: f64 = 1e-3;

/// What a technique is told of what is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Knowledge {
    /// Bounds of the scene and its objects, and the shadow distance.
    Bounds,
    /// A few hundred positions as well ([`Setting::visible_points`]).
    #[default]
    Points,
    /// Those, and the range of the depth buffer ([`Setting::visible_range`]).
    Depths,
}

/// Columns and rows of [`Setting::visible_points`]: one pixel in 25 × 25 of an 800 × 600 picture. Fewer miss thin
/// things near the eye; more change the strengths by less than a hundredth.
pub const SEEN_GRID: glam::UVec2 = glam::UVec2::new(32, 24);

/// A case's light in the library's units.
fn light_of(light: &CaseLight) -> Light {
    match *light {
        CaseLight::Directional { travel } => Light::Directional { travel },
        CaseLight::Spot { position, travel, half_angle_deg, range } => {
            Light::Spot { position, travel, half_angle: half_angle_deg.to_radians(), range }
        }
        CaseLight::Point { position, range } => Light::Point { position, range },
    }
}

/// Pixels of the pictures of built-in viewpoints: the thesis's 800 × 600.
pub const PICTURE: [u32; 2] = [800, 600];

/// A viewpoint as a case of the scene named `scene`.
#[must_use]
pub fn case_of(viewpoint: &Viewpoint, scene: &str) -> Case {
    Case {
        name: viewpoint.name.strip_prefix(&format!("{scene}-")).unwrap_or(&viewpoint.name).to_owned(),
        scene: scene.to_owned(),
        camera: super::case::CaseCamera {
            eye: viewpoint.eye,
            target: viewpoint.target,
            up: viewpoint.up,
            fov_y_deg: viewpoint.fov_y.to_degrees(),
            near: viewpoint.near,
            far: viewpoint.far,
        },
        light: CaseLight::Directional { travel: viewpoint.travel },
        viewport: PICTURE,
        shadow_distance: viewpoint.shadow_distance,
        folder: std::path::PathBuf::new(),
    }
}
