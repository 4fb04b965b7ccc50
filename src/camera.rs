//! The camera: where it stands, what it sees, and how to read both out of an engine's matrices.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, Mat4, UVec2};

use crate::error::{FitError, coordinate, finite};

/// A camera. World and view space are right-handed; the view looks along −z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// View space to world space: a right-handed rotation and a translation, in f64 so that worlds may be large.
    pub world_from_view: DMat4,
    /// What it sees.
    pub projection: Projection,
    /// Size of its picture in pixels, each 1 to 65536. Errors are predicted in pixels of it, [`Pcf::Pixel`](crate::Pcf)
    /// filters over them, and the mips of moments are chosen by them: what is drawn in another size is blurred by as
    /// much too little or too much.
    pub viewport: UVec2,
}

/// The shape of a view volume. Depths are eye depths: distances along the view direction, world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A frustum from the eye. The four numbers are tangents of the angles to its sides: for a symmetric frustum of
    /// vertical field of view θ and aspect a, `up = tan(θ/2) = −down`, `right = a·up = −left`.
    Perspective {
        /// Tangent to the left side; less than `right`.
        left: f64,
        /// Tangent to the right side.
        right: f64,
        /// Tangent to the lower side; less than `up`.
        down: f64,
        /// Tangent to the upper side.
        up: f64,
        /// Nearest eye depth, greater than 0.
        near: f64,
        /// Farthest eye depth, greater than `near`: at most 1e15, or `f64::INFINITY`.
        far: f64,
    },
    /// A box. The four numbers are distances from the view axis, world units.
    Orthographic {
        /// Left side; less than `right`.
        left: f64,
        /// Right side.
        right: f64,
        /// Lower side; less than `up`.
        down: f64,
        /// Upper side.
        up: f64,
        /// Nearest eye depth; may be negative.
        near: f64,
        /// Farthest eye depth, greater than `near`, finite.
        far: f64,
    },
}

/// The depth range of an engine's clip space, which its projection matrix alone does not tell: the `[-1, 1]` matrix of
/// a frustum from 1 to 100 *is* the `[0, 1]` matrix of one from 1.98 to 100.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipDepth {
    /// wgpu, Vulkan, Direct3D, Metal.
    ZeroToOne,
    /// OpenGL, WebGL.
    MinusOneToOne,
    /// Not known: takes the larger of the two frusta, which contains the other, so that no shadow is lost.
    Unknown,
}

/// Picture assumed by constructors that are given none: full HD, the commonest size. Set [`Camera::viewport`] where
/// yours has another. Matrices do not depend on it; see there for what does.
pub const DEFAULT_VIEWPORT: UVec2 = UVec2::new(1920, 1080);

/// How far a camera's axes may be from orthonormal, as the largest entry of `RᵀR − 1`. f32 matrices that were
/// multiplied a few times stay below 1e-5; a scale of 1 % shows as 2e-2. Smaller refuses cameras that engines do send,
/// larger lets a scaled view through, whose eye depths would be wrong.
const RIGID_TOLERANCE: f64 = 1e-3;

impl Camera {
    /// A symmetric perspective camera with the default viewport.
    ///
    /// `fov_y` is the full vertical angle in radians, 0 to π; `aspect` is width over height.
    #[must_use]
    pub fn perspective(world_from_view: DMat4, fov_y: f64, aspect: f64, near: f64, far: f64) -> Self {
        let up = (0.5 * fov_y).tan();
        let right = up * aspect;
        let projection = Projection::Perspective { left: -right, right, down: -up, up, near, far };
        Self { world_from_view, projection, viewport: DEFAULT_VIEWPORT }
    }

    /// `world_from_view` of a camera at `eye` that looks at `target`; `up` may be any direction that is not along the
    /// view. Entries are NaN where the directions do not determine a frame,
    /// which [`fit`](crate::ShadowTechnique::fit) refuses.
    #[must_use]
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> DMat4 {
        let back = (eye - target).normalize();
        let right = up.cross(back).normalize();
        DMat4::from_cols(right.extend(0.0), back.cross(right).extend(0.0), back.extend(0.0), eye.extend(1.0))
    }

    /// Reads a camera out of an engine's matrices (f64).
    ///
    /// Recognised: perspective (`w = −z`) and orthographic projections; standard and reversed depth; finite and
    /// infinite far; off-centre and jittered frusta; mirrored x or y (flipped clip space). The projection may carry any
    /// positive scale.
    ///
    /// # Errors
    /// [`FitError::NotAProjection`] names the entry that rules the matrix out; other errors name `world_from_view` or
    /// the recovered plane.
    pub fn from_matrices(world_from_view: DMat4, clip_from_view: DMat4, depth: ClipDepth) -> Result<Self, FitError> {
        Self::recognise(world_from_view, clip_from_view, depth, f64::EPSILON)
    }

    /// [`from_matrices`](Self::from_matrices) for f32 matrices:
    /// far planes that f32 cannot tell from infinity are infinite.
    ///
    /// # Errors
    /// As [`from_matrices`](Self::from_matrices).
    pub fn from_matrices_f32(world_from_view: Mat4, clip_from_view: Mat4, depth: ClipDepth) -> Result<Self, FitError> {
        Self::recognise(world_from_view.as_dmat4(), clip_from_view.as_dmat4(), depth, f64::from(f32::EPSILON))
    }

    fn recognise(world_from_view: DMat4, clip_from_view: DMat4, depth: ClipDepth, ulp: f64) -> Result<Self, FitError> {
        let projection = Projection::recognise(clip_from_view, depth, ulp)?;
        let camera = Self { world_from_view, projection, viewport: DEFAULT_VIEWPORT };
        camera.validate()?;
        Ok(camera)
    }

    /// The position of the eye (the origin of view space), world space.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.world_from_view.w_axis.truncate()
    }

    /// The direction of view, unit length up to the tolerance of the matrix.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        -self.world_from_view.z_axis.truncate()
    }

    /// Checks every field.
    pub(crate) fn validate(&self) -> Result<(), FitError> {
        let entries = self.world_from_view.to_cols_array();
        for value in entries {
            coordinate("camera.world_from_view", value)?;
        }
        // Inverting an f32 matrix leaves an ulp in the last row, which nothing reads.
        let deviation = (self.world_from_view.row(3) - DVec4::W).abs().max_element();
        if deviation > RIGID_TOLERANCE {
            return Err(FitError::NotRigid { field: "camera.world_from_view", deviation });
        }
        let rotation = DMat3::from_mat4(self.world_from_view);
        let gram = rotation.transpose() * rotation - DMat3::IDENTITY;
        let deviation = gram.to_cols_array().into_iter().fold(0.0_f64, |worst, entry| worst.max(entry.abs()));
        if deviation > RIGID_TOLERANCE {
            return Err(FitError::NotRigid { field: "camera.world_from_view", deviation });
        }
        let determinant = rotation.determinant();
        if determinant < 0.0 {
            return Err(FitError::NotRigid { field: "camera.world_from_view", deviation: determinant });
        }
        for pixels in self.viewport.to_array() {
            if !(1..=65_536).contains(&pixels) {
                let value = f64::from(pixels);
                return Err(FitError::OutOfRange { field: "camera.viewport", value, legal: "1 to 65536 pixels" });
            }
        }
        self.projection.validate()
    }

    /// Corners of the view volume between two eye depths, in render space (world − `origin`), numbered by bits as
    /// `Convex::hexahedron` wants them. Corners at infinite depth are directions (w = 0).
    pub(crate) fn corners(&self, near: f64, far: f64, origin: DVec3) -> [DVec4; 8] {
        let rotation = DMat3::from_mat4(self.world_from_view);
        let eye = self.eye() - origin;
        let (left, right, down, up, spreads) = self.projection.sides();
        core::array::from_fn(|bits| {
            let x = if bits & 1 == 0 { left } else { right };
            let y = if bits & 2 == 0 { down } else { up };
            let depth = if bits & 4 == 0 { near } else { far };
            if !depth.is_finite() {
                return (rotation * DVec3::new(x, y, -1.0)).normalize().extend(0.0);
            }
            let spread = if spreads { depth } else { 1.0 };
            (eye + rotation * DVec3::new(x * spread, y * spread, -depth)).extend(1.0)
        })
    }

    /// Pixels per world unit at eye depth 1 (perspective) or everywhere (orthographic), along the picture's finer axis.
    pub(crate) fn pixels_per_unit(&self) -> f64 {
        (self.viewport.as_dvec2() / self.projection.size_at(1.0)).max_element()
    }

    /// Where a point of render space is in the picture: tangents from the view axis, or distances (orthographic).
    pub(crate) fn picture_position(&self, position: DVec3, origin: DVec3) -> DVec2 {
        let from_eye = position - (self.eye() - origin);
        let at = DVec2::new(
            self.world_from_view.x_axis.truncate().dot(from_eye),
            self.world_from_view.y_axis.truncate().dot(from_eye),
        );
        match self.projection {
            Projection::Perspective { near, .. } => at / from_eye.dot(self.forward()).max(near),
            Projection::Orthographic { .. } => at,
        }
    }

    /// The ray of a place in the picture, as (start, direction) in render space:
    /// its point of eye depth ζ is start + ζ direction.
    pub(crate) fn ray(&self, at: DVec2, origin: DVec3) -> (DVec3, DVec3) {
        let eye = self.eye() - origin;
        let aside = self.world_from_view.x_axis.truncate() * at.x + self.world_from_view.y_axis.truncate() * at.y;
        match self.projection {
            Projection::Perspective { .. } => (eye, aside + self.forward()),
            Projection::Orthographic { .. } => (eye + aside, self.forward()),
        }
    }

    /// Eye depth of a point of render space.
    pub(crate) fn eye_depth(&self, position: DVec3, origin: DVec3) -> f64 {
        (position - (self.eye() - origin)).dot(self.forward())
    }
}

impl Projection {
    /// Nearest and farthest eye depth.
    #[must_use]
    pub fn depth_range(&self) -> (f64, f64) {
        match *self {
            Self::Perspective { near, far, .. } | Self::Orthographic { near, far, .. } => (near, far),
        }
    }

    /// Left, right, down, up, and whether they grow with depth.
    fn sides(&self) -> (f64, f64, f64, f64, bool) {
        match *self {
            Self::Perspective { left, right, down, up, .. } => (left, right, down, up, true),
            Self::Orthographic { left, right, down, up, .. } => (left, right, down, up, false),
        }
    }

    /// Whether what is seen grows with depth.
    pub(crate) fn spreads(&self) -> bool {
        matches!(self, Self::Perspective { .. })
    }

    /// Sine of the angle from the view axis to the widest side; 0 for orthographic cameras.
    pub(crate) fn half_angle_sine(&self) -> f64 {
        let (left, right, down, up, spreads) = self.sides();
        let tangent = left.abs().max(right.abs()).max(down.abs()).max(up.abs());
        if spreads { tangent / tangent.hypot(1.0) } else { 0.0 }
    }

    /// The middle of the picture: tangents from the view axis, or distances (orthographic).
    pub(crate) fn middle(&self) -> DVec2 {
        let (left, right, down, up, _) = self.sides();
        DVec2::new(left.midpoint(right), down.midpoint(up))
    }

    /// Width and height of the picture in world units at an eye depth.
    pub(crate) fn size_at(&self, depth: f64) -> DVec2 {
        let (left, right, down, up, spreads) = self.sides();
        DVec2::new(right - left, up - down) * if spreads { depth } else { 1.0 }
    }

    fn validate(&self) -> Result<(), FitError> {
        let (left, right, down, up, perspective) = self.sides();
        let (near, far) = self.depth_range();
        coordinate("camera.projection.left", left)?;
        coordinate("camera.projection.right", right)?;
        coordinate("camera.projection.down", down)?;
        coordinate("camera.projection.up", up)?;
        coordinate("camera.projection.near", near)?;
        if !(perspective && far == f64::INFINITY) {
            coordinate("camera.projection.far", far)?;
        }
        ordered("camera.projection.left", left, "camera.projection.right", right, "left < right")?;
        ordered("camera.projection.down", down, "camera.projection.up", up, "down < up")?;
        if perspective && !(near > 0.0) {
            let field = "camera.projection.near";
            return Err(FitError::OutOfRange { field, value: near, legal: "greater than 0 (perspective)" });
        }
        ordered("camera.projection.near", near, "camera.projection.far", far, "near < far")
    }

    /// Reads the planes out of a projection matrix; `ulp` is the relative precision of its entries.
    fn recognise(clip_from_view: DMat4, depth: ClipDepth, ulp: f64) -> Result<Self, FitError> {
        for value in clip_from_view.to_cols_array() {
            finite("clip_from_view", value)?;
        }
        // Row w decides: (0, 0, -s, 0) is a perspective, (0, 0, 0, s) an orthographic projection.
        let row_w = clip_from_view.row(3);
        let (scale, perspective) = if row_w.z < 0.0 { (-row_w.z, true) } else { (row_w.w, false) };
        let expected = if perspective { DVec4::new(0.0, 0.0, -scale, 0.0) } else { DVec4::new(0.0, 0.0, 0.0, scale) };
        if let Some(column) = (0..4).find(|&column| row_w[column] != expected[column]) {
            return Err(not_a_projection(
                3 + 4 * column,
                row_w[column],
                "w = -z (perspective) or w = 1 (orthographic)",
            ));
        }
        if !(scale > 0.0) {
            return Err(not_a_projection(15, scale, "w = -z (perspective) or w = 1 (orthographic)"));
        }
        let ndc = clip_from_view * (1.0 / scale);
        reject_shear(&ndc)?;
        let (near, far) = recognise_depth(ndc.z_axis.z, ndc.w_axis.z, perspective, depth, ulp)?;
        // Sides: where the picture's coordinates reach -1 and 1.
        let shift = if perspective { ndc.z_axis } else { -ndc.w_axis };
        let side = |sign: f64, shift: f64, scale: f64| (sign + shift) / scale;
        let (x0, x1) = (side(-1.0, shift.x, ndc.x_axis.x), side(1.0, shift.x, ndc.x_axis.x));
        let (y0, y1) = (side(-1.0, shift.y, ndc.y_axis.y), side(1.0, shift.y, ndc.y_axis.y));
        let (left, right, down, up) = (x0.min(x1), x0.max(x1), y0.min(y1), y0.max(y1));
        Ok(if perspective {
            Self::Perspective { left, right, down, up, near, far }
        } else {
            Self::Orthographic { left, right, down, up, near, far }
        })
    }
}

fn ordered(lower: &'static str, a: f64, upper: &'static str, b: f64, legal: &'static str) -> Result<(), FitError> {
    if a < b { Ok(()) } else { Err(FitError::NotOrdered { lower, lower_value: a, upper, upper_value: b, legal }) }
}

fn not_a_projection(entry: usize, value: f64, legal: &'static str) -> FitError {
    FitError::NotAProjection { field: "clip_from_view", entry, value, legal }
}

/// x may depend on x, z and 1 only, y on y, z and 1, z on z and 1; and neither picture axis may be flat.
fn reject_shear(ndc: &DMat4) -> Result<(), FitError> {
    for (entry, value) in [(1, ndc.x_axis.y), (2, ndc.x_axis.z), (4, ndc.y_axis.x), (6, ndc.y_axis.z)] {
        if value != 0.0 {
            return Err(not_a_projection(entry, value, "0 (no shear, no oblique near plane)"));
        }
    }
    for (entry, value) in [(0, ndc.x_axis.x), (5, ndc.y_axis.y)] {
        if value == 0.0 {
            return Err(not_a_projection(entry, value, "not 0"));
        }
    }
    Ok(())
}

/// Near and far from the depth row `z_ndc = a·z + b·1` (before division by −z for a perspective).
///
/// Perspective: `z_ndc(ζ) = −a + b/ζ`; orthographic: `z_ndc(ζ) = −a·ζ + b`. It falls with ζ when depth is reversed.
fn recognise_depth(a: f64, b: f64, perspective: bool, depth: ClipDepth, ulp: f64) -> Result<(f64, f64), FitError> {
    let reversed = if perspective { b > 0.0 } else { a > 0.0 };
    let at = |value: f64| if perspective { b / (value + a) } else { (b - value) / a };
    let plane = |value: f64| {
        // value + a is lost in rounding: the depth is reached at infinity only.
        let lost = perspective && (value + a).abs() <= 4.0 * ulp * value.abs().max(a.abs());
        if lost { f64::INFINITY } else { at(value) }
    };
    let low_value = if depth == ClipDepth::ZeroToOne { 0.0 } else { -1.0 };
    let (mut near, far) = if reversed { (plane(1.0), plane(low_value)) } else { (plane(low_value), plane(1.0)) };
    let mut far = if far < 0.0 && perspective { f64::INFINITY } else { far };
    if depth == ClipDepth::Unknown {
        // The other reading: near differs under standard depth, far under reversed depth. Keep the larger frustum.
        let other = plane(0.0);
        if reversed {
            far = if other < 0.0 { f64::INFINITY } else { far.max(other) };
        } else {
            near = near.min(other);
        }
    }
    if !near.is_finite() || (perspective && !(near > 0.0)) {
        return Err(not_a_projection(10, a, "a depth row whose near plane is in front of the eye"));
    }
    if !(near < far) {
        return Err(not_a_projection(14, b, "a depth row with near < far"));
    }
    Ok((near, far))
}

#[cfg(test)]
mod tests;
