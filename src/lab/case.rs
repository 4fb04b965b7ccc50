//! Case files: one camera, one light, one scene, as JSON.
//!
//! ```json
//! {"name": "street", "scene": "street.glb",
//!  "camera": {"eye": [0, 2, 9], "target": [0, 1, 0], "up": [0, 1, 0], "fov_y_deg": 45, "near": 0.5, "far": 60},
//!  "light": {"kind": "directional", "travel": [0, -1, 0]},
//!  "viewport": [800, 600], "shadow_distance": 60}
//! ```
//! Other lights: `{"kind": "spot", "position", "travel", "half_angle_deg", "range"}` and `{"kind": "point",
//! "position", "range"}`. Fields this version does not know are passed over.

use std::fmt;
use std::path::{Path, PathBuf};

use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};

/// One camera and one light over one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Name shown in reports.
    pub name: String,
    /// A built-in scene's name ([`BUILT_IN_SCENES`]) or a path; see [`Case::scene_source`].
    pub scene: String,
    /// The eye.
    pub camera: CaseCamera,
    /// The light.
    pub light: CaseLight,
    /// Width and height of the picture in pixels, each 1 to 16384.
    pub viewport: [u32; 2],
    /// Eye depth up to which a technique has to cast shadows, world units, positive.
    pub shadow_distance: f64,
    /// Folder that a relative `scene` starts from; [`Case::load`] sets the case file's.
    #[serde(skip)]
    pub folder: PathBuf,
}

/// A perspective camera that looks from `eye` at `target`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseCamera {
    /// Position of the eye in world space.
    #[serde(with = "array")]
    pub eye: DVec3,
    /// A point in the middle of the picture; not the eye.
    #[serde(with = "array")]
    pub target: DVec3,
    /// A direction that is up in the picture; not parallel to the view. Any length.
    #[serde(with = "array")]
    pub up: DVec3,
    /// Angle between the lower and the upper edge, degrees, between 0 and 180.
    pub fov_y_deg: f64,
    /// Eye depth of the near plane, world units, positive.
    pub near: f64,
    /// Eye depth of the far plane, world units, beyond `near`.
    pub far: f64,
}

/// A light; `travel` is the unit vector along which its light travels (along its axis, for a spot).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum CaseLight {
    /// Light from infinity.
    Directional {
        /// Direction of the light, a unit vector in world space.
        #[serde(with = "array")]
        travel: DVec3,
    },
    /// A cone of light.
    Spot {
        /// Tip of the cone in world space.
        #[serde(with = "array")]
        position: DVec3,
        /// Axis of the cone, a unit vector in world space.
        #[serde(with = "array")]
        travel: DVec3,
        /// Angle between axis and edge, degrees, between 0 and 90.
        half_angle_deg: f64,
        /// Distance the light reaches, world units, positive.
        range: f64,
    },
    /// Light to all sides.
    Point {
        /// Position in world space.
        #[serde(with = "array")]
        position: DVec3,
        /// Distance the light reaches, world units, positive.
        range: f64,
    },
}

/// Where a case's geometry comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneSource {
    /// One of [`BUILT_IN_SCENES`].
    BuiltIn(String),
    /// A glTF file that exists.
    File(PathBuf),
}

/// Names of the scenes that need no file.
pub const BUILT_IN_SCENES: [&str; 2] = ["treeline", "sparse-city"];

/// Why a case file could not be used; its text is one line that names the field and what is legal.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CaseError {
    /// The file cannot be read.
    Unreadable {
        /// The case file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// The file is not JSON, lacks a field, or has one of the wrong type.
    Malformed {
        /// The case file.
        path: PathBuf,
        /// What the parser says, with line and column.
        reason: String,
    },
    /// A field's value is out of its range.
    Field {
        /// The field, as `camera.near`.
        field: &'static str,
        /// Its value.
        value: String,
        /// What it may be.
        legal: &'static str,
    },
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { path, reason } => {
                write!(f, "{}: cannot be read ({reason}); expected a case file in JSON", path.display())
            }
            Self::Malformed { path, reason } => write!(
                f,
                "{}: {reason}; expected an object with name, scene, camera, light, viewport, shadow_distance",
                path.display()
            ),
            Self::Field { field, value, legal } => write!(f, "{field} is {value}; legal is {legal}"),
        }
    }
}

impl std::error::Error for CaseError {}

/// Greatest width or height of a picture, pixels: what graphics adapters guarantee at best.
const MAX_VIEWPORT: u32 = 16384;

/// How far the length of `travel` may be from 1 before it is taken for a mistake: decimal digits cut off in a file stay
/// below it, a vector that was never normalised does not.
const UNIT_TOLERANCE: f64 = 1e-3;

/// Least sine of the angle between `up` and the view: below it the picture's roll would be noise.
const MIN_UP_SINE: f64 = 1e-6;

impl Case {
    /// Reads and checks a case file.
    ///
    /// # Errors
    /// [`CaseError`] when the file cannot be read, is not a case, or holds an illegal value.
    pub fn load(path: &Path) -> Result<Self, CaseError> {
        let reason = |error: &dyn fmt::Display| error.to_string().replace('\n', " ");
        let text = std::fs::read_to_string(path)
            .map_err(|error| CaseError::Unreadable { path: path.to_owned(), reason: reason(&error) })?;
        let mut case: Self = serde_json::from_str(&text)
            .map_err(|error| CaseError::Malformed { path: path.to_owned(), reason: reason(&error) })?;
        case.folder = path.parent().map(Path::to_owned).unwrap_or_default();
        case.check()
    }

    /// Checks every field and normalises `travel`.
    ///
    /// # Errors
    /// [`CaseError::Field`] for the first field that is out of range.
    pub fn check(mut self) -> Result<Self, CaseError> {
        self.camera.check()?;
        self.light = self.light.check()?;
        let [width, height] = self.viewport;
        let legal_side = 1..=MAX_VIEWPORT;
        let viewport = format!("[{width}, {height}]");
        require(
            "viewport",
            &viewport,
            legal_side.contains(&width) && legal_side.contains(&height),
            "1 to 16384 pixels each",
        )?;
        positive("shadow_distance", self.shadow_distance)?;
        Ok(self)
    }

    /// Finds the scene: a built-in one by name, else a file relative to the case file's folder, else to that
    /// folder's parent.
    ///
    /// # Errors
    /// [`CaseError::Field`] when there is no such file either.
    pub fn scene_source(&self) -> Result<SceneSource, CaseError> {
        if BUILT_IN_SCENES.contains(&self.scene.as_str()) {
            return Ok(SceneSource::BuiltIn(self.scene.clone()));
        }
        let candidates = [self.folder.join(&self.scene), self.folder.join("..").join(&self.scene)];
        match candidates.into_iter().find(|path| path.is_file()) {
            Some(path) => Ok(SceneSource::File(path)),
            None => Err(CaseError::Field {
                field: "scene",
                value: format!("\"{}\"", self.scene),
                legal: "treeline, sparse-city, or a file's path relative to the case file's folder or its parent",
            }),
        }
    }

    /// Tangents of the angles from the view axis to the left, right, lower and upper edge (left and lower negative).
    #[must_use]
    pub fn tangents(&self) -> [f64; 4] {
        let up = (self.camera.fov_y_deg.to_radians() * 0.5).tan();
        let right = up * f64::from(self.viewport[0]) / f64::from(self.viewport[1]);
        [-right, right, -up, up]
    }

    /// Returns the rigid transform from view space (x right, y up, looking along −z) to world space.
    #[must_use]
    pub fn world_from_view(&self) -> DMat4 {
        self.camera.world_from_view()
    }
}

impl CaseCamera {
    /// Returns the rigid transform from view space (x right, y up, looking along −z) to world space.
    #[must_use]
    pub fn world_from_view(&self) -> DMat4 {
        let back = (self.eye - self.target).normalize();
        let right = self.up.cross(back).normalize();
        let up = back.cross(right);
        DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), self.eye.extend(1.0))
    }

    fn check(&self) -> Result<(), CaseError> {
        finite("camera.eye", self.eye)?;
        finite("camera.target", self.target)?;
        finite("camera.up", self.up)?;
        let view = self.target - self.eye;
        let has_view = view.length() > 0.0 && view.length().is_finite();
        require("camera.target", &self.target, has_view, "any point but camera.eye")?;
        let sine = self.up.normalize_or_zero().cross(view.normalize()).length();
        require("camera.up", &self.up, sine > MIN_UP_SINE, "a direction not parallel to target - eye")?;
        let fov = self.fov_y_deg;
        require("camera.fov_y_deg", &fov, fov > 0.0 && fov < 180.0, "more than 0 and less than 180 degrees")?;
        positive("camera.near", self.near)?;
        let far = self.far;
        require("camera.far", &far, far > self.near && far.is_finite(), "a finite number greater than camera.near")
    }
}

impl CaseLight {
    fn check(self) -> Result<Self, CaseError> {
        match self {
            Self::Directional { travel } => Ok(Self::Directional { travel: unit("light.travel", travel)? }),
            Self::Spot { position, travel, half_angle_deg, range } => {
                finite("light.position", position)?;
                let travel = unit("light.travel", travel)?;
                let legal = half_angle_deg > 0.0 && half_angle_deg < 90.0;
                require("light.half_angle_deg", &half_angle_deg, legal, "more than 0 and less than 90 degrees")?;
                positive("light.range", range)?;
                Ok(Self::Spot { position, travel, half_angle_deg, range })
            }
            Self::Point { position, range } => {
                finite("light.position", position)?;
                positive("light.range", range)?;
                Ok(self)
            }
        }
    }
}

/// Fails with the field's name and value unless `legal` holds; a comparison with NaN never holds.
fn require(field: &'static str, value: &dyn fmt::Display, legal: bool, range: &'static str) -> Result<(), CaseError> {
    if legal { Ok(()) } else { Err(CaseError::Field { field, value: value.to_string(), legal: range }) }
}

fn finite(field: &'static str, value: DVec3) -> Result<(), CaseError> {
    require(field, &value, value.is_finite(), "three finite numbers")
}

fn positive(field: &'static str, value: f64) -> Result<(), CaseError> {
    require(field, &value, value > 0.0 && value.is_finite(), "a finite number greater than 0")
}

fn unit(field: &'static str, value: DVec3) -> Result<DVec3, CaseError> {
    let length = value.length();
    require(field, &value, (length - 1.0).abs() <= UNIT_TOLERANCE, "a vector of length 1 (to within 0.001)")?;
    Ok(value / length)
}

/// Vectors as JSON arrays of three numbers.
mod array {
    use glam::DVec3;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(vector: &DVec3, serializer: S) -> Result<S::Ok, S::Error> {
        vector.to_array().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
        <[f64; 3]>::deserialize(deserializer).map(DVec3::from_array)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec4;
    use serde_json::{Value, json};

    use super::*;

    fn document() -> Value {
        json!({
            "name": "street", "scene": "treeline", "note": "fields nobody knows are passed over",
            "camera": {"eye": [1, 2, 3], "target": [1, 2, -7], "up": [0, 5, 1], "fov_y_deg": 90, "near": 0.5, "far": 60},
            "light": {"kind": "directional", "travel": [0, -0.9995, 0]},
            "viewport": [800, 400], "shadow_distance": 60,
        })
    }

    fn load(document: &Value) -> Result<Case, CaseError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("case.json");
        std::fs::write(&path, document.to_string()).unwrap();
        Case::load(&path)
    }

    #[test]
    fn a_case_is_read_and_its_light_normalised() {
        let case = load(&document()).unwrap();
        assert_eq!(case.light, CaseLight::Directional { travel: DVec3::NEG_Y });
        assert_eq!(case.viewport, [800, 400]);
        assert_eq!(case.scene_source(), Ok(SceneSource::BuiltIn("treeline".into())));
        let expected = [-2.0, 2.0, -1.0, 1.0];
        assert!(case.tangents().iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12));
    }

    #[test]
    fn the_view_is_right_handed_and_looks_along_minus_z() {
        let world_from_view = load(&document()).unwrap().world_from_view();
        let expected = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0));
        // `up` leans along the view: its part across the view is what counts.
        assert!(world_from_view.abs_diff_eq(expected, 1e-12));
        let ahead = world_from_view * DVec4::new(0.0, 0.0, -10.0, 1.0);
        assert!(ahead.abs_diff_eq(DVec4::new(1.0, 2.0, -7.0, 1.0), 1e-12));
        assert!((world_from_view.determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn spot_and_point_lights_are_read() {
        let mut spot = document();
        spot["light"] =
            json!({"kind": "spot", "position": [0, 9, 0], "travel": [0, -1, 0], "half_angle_deg": 30, "range": 40});
        let light = CaseLight::Spot {
            position: DVec3::new(0.0, 9.0, 0.0),
            travel: DVec3::NEG_Y,
            half_angle_deg: 30.0,
            range: 40.0,
        };
        assert_eq!(load(&spot).unwrap().light, light);
        let mut point = document();
        point["light"] = json!({"kind": "point", "position": [0, 9, 0], "range": 40});
        assert_eq!(load(&point).unwrap().light, CaseLight::Point { position: DVec3::new(0.0, 9.0, 0.0), range: 40.0 });
    }

    /// Every field, one illegal value, and the line it gives.
    #[test]
    fn illegal_values_are_named() {
        let spot = |half_angle: f64, range: f64| json!({"kind": "spot", "position": [0, 9, 0], "travel": [0, -1, 0], "half_angle_deg": half_angle, "range": range});
        let table = [
            ("/camera/near", json!(0), "camera.near is 0; legal is a finite number greater than 0"),
            ("/camera/near", json!(60), "camera.far is 60; legal is a finite number greater than camera.near"),
            (
                "/camera/fov_y_deg",
                json!(180),
                "camera.fov_y_deg is 180; legal is more than 0 and less than 180 degrees",
            ),
            ("/camera/target", json!([1, 2, 3]), "camera.target is [1, 2, 3]; legal is any point but camera.eye"),
            (
                "/camera/up",
                json!([0, 0, 4]),
                "camera.up is [0, 0, 4]; legal is a direction not parallel to target - eye",
            ),
            (
                "/camera/up",
                json!([0, 0, 0]),
                "camera.up is [0, 0, 0]; legal is a direction not parallel to target - eye",
            ),
            ("/viewport", json!([0, 600]), "viewport is [0, 600]; legal is 1 to 16384 pixels each"),
            ("/viewport", json!([800, 16385]), "viewport is [800, 16385]; legal is 1 to 16384 pixels each"),
            ("/shadow_distance", json!(-1), "shadow_distance is -1; legal is a finite number greater than 0"),
            (
                "/light/travel",
                json!([0, -1.1, 0]),
                "light.travel is [0, -1.1, 0]; legal is a vector of length 1 (to within 0.001)",
            ),
            ("/light", spot(90.0, 1.0), "light.half_angle_deg is 90; legal is more than 0 and less than 90 degrees"),
            ("/light", spot(30.0, 0.0), "light.range is 0; legal is a finite number greater than 0"),
        ];
        for (pointer, value, expected) in table {
            let mut document = document();
            *document.pointer_mut(pointer).unwrap() = value;
            assert_eq!(load(&document).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn numbers_that_are_none_are_refused_in_cases_made_in_code() {
        let good = load(&document()).unwrap();
        let spoil: [fn(&mut Case); 6] = [
            |case| case.camera.eye.x = f64::NAN,
            |case| case.camera.target.y = f64::INFINITY,
            |case| case.camera.far = f64::INFINITY,
            |case| case.camera.fov_y_deg = f64::NAN,
            |case| case.shadow_distance = f64::NAN,
            |case| case.light = CaseLight::Directional { travel: DVec3::NAN },
        ];
        for spoil in spoil {
            let mut case = good.clone();
            spoil(&mut case);
            assert!(matches!(case.check(), Err(CaseError::Field { .. })));
        }
    }

    #[test]
    fn missing_and_unknown_parts_are_named_in_one_line() {
        let mut without_near = document();
        without_near["camera"].as_object_mut().unwrap().remove("near");
        let mut unknown_light = document();
        unknown_light["light"]["kind"] = json!("laser");
        for (document, expected) in [(without_near, "missing field `near`"), (unknown_light, "unknown variant `laser`")]
        {
            let text = load(&document).unwrap_err().to_string();
            assert!(text.contains(expected) && text.contains("case.json: ") && !text.contains('\n'), "{text}");
        }
        let missing = Case::load(Path::new("no/such/case.json")).unwrap_err();
        assert!(missing.to_string().starts_with("no/such/case.json: cannot be read"));
    }

    #[test]
    fn scenes_are_sought_beside_the_case_and_one_folder_up() {
        let folder = tempfile::tempdir().unwrap();
        let cases = folder.path().join("cases");
        std::fs::create_dir_all(folder.path().join("scenes")).unwrap();
        std::fs::create_dir_all(&cases).unwrap();
        let mut document = document();
        document["scene"] = json!("scenes/a.glb");
        std::fs::write(cases.join("case.json"), document.to_string()).unwrap();
        let case = Case::load(&cases.join("case.json")).unwrap();
        let text = case.scene_source().unwrap_err().to_string();
        assert!(text.starts_with("scene is \"scenes/a.glb\"; legal is treeline"), "{text}");
        // One folder up it is found; beside the case it comes first.
        std::fs::write(folder.path().join("scenes/a.glb"), "").unwrap();
        assert_eq!(case.scene_source(), Ok(SceneSource::File(cases.join("../scenes/a.glb"))));
        std::fs::create_dir_all(cases.join("scenes")).unwrap();
        std::fs::write(cases.join("scenes/a.glb"), "").unwrap();
        assert_eq!(case.scene_source(), Ok(SceneSource::File(cases.join("scenes/a.glb"))));
    }
}
