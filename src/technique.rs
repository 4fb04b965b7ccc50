//! The one trait: inputs to frame.

use glam::DVec3;

use crate::camera::Camera;
use crate::error::{FitError, coordinate};
use crate::frame::{ShadowFrame, WgslKey};
use crate::light::Light;
use crate::scene::{MapBudget, Scene};

/// What a fit reads. Plain values; nothing is kept between calls.
#[derive(Clone, Copy, Debug)]
pub struct FitInput<'a> {
    /// The camera.
    pub camera: Camera,
    /// The light.
    pub light: Light,
    /// What the scene holds.
    pub scene: Scene<'a>,
    /// The texels that may be used.
    pub map: MapBudget,
    /// World position of the origin of render space, the space of the emitted matrices. For small worlds zero; for
    /// large ones the eye, or whatever the engine subtracts before it narrows positions to f32.
    pub origin: DVec3,
    /// Last frame of the same light: history is an input. Read for [`ShadowView::content`](crate::ShadowView::content),
    /// and so that maps keep their sizes where [`Share`](crate::Share) gives them different ones, and their depths
    /// where [`Scheme::EqualError`](crate::Scheme::EqualError) chooses them.
    pub previous: Option<&'a ShadowFrame>,
}

impl FitInput<'_> {
    /// Checks every field; gives the input back with directions normalised.
    pub(crate) fn validate(mut self) -> Result<Self, FitError> {
        self.camera.validate()?;
        self.light = self.light.validate()?;
        self.scene.validate()?;
        self.map.validate()?;
        for component in self.origin.to_array() {
            coordinate("origin", component)?;
        }
        Ok(self)
    }
}

/// A way to map shadows: pure, object-safe, and open to implementations outside this crate.
///
/// Equal inputs give equal bits on one build; across platforms as far as `sqrt` and `fma`-free arithmetic agree, which
/// IEEE 754 grants.
pub trait ShadowTechnique {
    /// Fits the maps of one light to one frame.
    ///
    /// Allocates nothing and touches no GPU. "Nothing to shadow" is an `Ok` frame without views and with reasons in
    /// [`ShadowFrame::left_out`].
    ///
    /// # Errors
    /// A broken precondition, named by field, value and legal range.
    fn fit(&self, input: &FitInput) -> Result<ShadowFrame, FitError>;

    /// The shader text that reads this technique's frames. Constant for constant options.
    fn wgsl_key(&self) -> WgslKey;
}
