//! What lookups need of a pixel: where it is seen from, and how large it is.

use glam::DVec4;

use crate::fit::view::Fitter;
use crate::frame::ViewUniforms;

impl Fitter<'_> {
    /// Writes the eye and the size of a pixel for filters that follow it.
    pub(crate) fn pixel(&self, uniforms: &mut ViewUniforms) {
        let (camera, origin) = (&self.input.camera, self.input.origin);
        let forward = camera.forward();
        let (size, eye) = if camera.projection.spreads() {
            let eye = camera.eye() - origin;
            (forward.extend(-forward.dot(eye)), eye.extend(1.0))
        } else {
            (DVec4::W, (-forward).extend(0.0))
        };
        uniforms.pixel_from_render = (size / camera.pixels_per_unit()).as_vec4().to_array();
        uniforms.moments = eye.as_vec4().to_array();
    }
}
