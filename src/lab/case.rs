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
mod tests;
