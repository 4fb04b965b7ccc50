//! A number for each class of artefact in the thesis's Table 1.

use antumbra::aliasing::Spread;
use antumbra::lab::truth::Truth;
use glam::{DVec3, Vec3};

/// Cosine of the angle to the light (80°) from which a surface counts as grazed. The thesis's rule begins at 85°: a
/// wider band holds more pixels and what lies just beside that rule.
const GRAZED: f32 = 0.173_648_18;

/// What shows in one picture.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Artefacts {
    /// Perspective aliasing: pixels per texel that half of what is seen has at most, and 19 in 20.
    pub(crate) perspective: [f64; 2],
    /// Projection aliasing: sum of |error| over grazed pixels, and their number.
    pub(crate) grazed: [f64; 2],
    /// Binary edges: pixels that an edge passes through, those of them that are grey, and the sum of squared errors.
    pub(crate) edges: [f64; 3],
}

impl Artefacts {
    pub(crate) fn of(mask: &[u8], truth: &Truth, travel: DVec3, perspective: Option<Spread>) -> Self {
        let to_light = -travel.as_vec3();
        let mut found =
            Self { perspective: perspective.map_or([f64::NAN; 2], |s| [s.median, s.high]), ..Self::default() };
        for (pixel, byte) in mask.iter().enumerate().filter(|(pixel, _)| truth.valid[*pixel]) {
            let area = truth.area[pixel];
            let error = f64::from(f32::from(*byte) / f32::from(u8::MAX) - area);
            if Vec3::from(truth.normal[pixel]).dot(to_light) < GRAZED {
                found.grazed[0] += error.abs();
                found.grazed[1] += 1.0;
            }
            if area > 0.0 && area < 1.0 {
                found.edges[0] += 1.0;
                found.edges[1] += f64::from(u8::from((1..u8::MAX).contains(byte)));
                found.edges[2] += error * error;
            }
        }
        found
    }
}
