//! Footprints over a picture: what a fit predicts, measured at every point that is seen.

use rayon::prelude::*;

use super::cpu::Visible;
use super::serving::serving;
use super::subject::Setting;
use crate::aliasing::{PointFootprint, Spread, footprint_at};
use crate::encoding::footprint::antumbra_footprint_colour;
use crate::frame::ShadowFrame;

/// Footprints of a frame's maps over a picture: at each point, those of the map that serves it.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Pixel by pixel, row 0 on top; `None` where none is judged or no map serves what is seen.
    points: Vec<Option<PointFootprint>>,
    /// Pixels that are judged.
    valid: Vec<bool>,
    /// Pixels per texel over the valid pixels that a map serves.
    pub pixels_per_texel: Option<Spread>,
    /// Their perspective part: what a fit predicts the extremes of.
    pub perspective: Option<Spread>,
    /// Share of the valid pixels that no map serves.
    pub unserved: f64,
}

/// Side of a pixel of [`Measured::paint`], pixels of the picture: footprints change slowly but for slants, and a report
/// holds one picture of them for each run. At 1 a report doubles, at 4 thin things are gone.
pub const COARSENESS: usize = 2;

/// Steps of colour to a factor of two. Fewer show as bands, more make pictures larger that look the same.
const STEPS: f64 = 8.0;

/// Where nothing is judged (sky, and what is turned away from the light), and where no map serves what is seen;
/// 8-bit sRGB.
const UNJUDGED_COLOUR: [u8; 3] = [120, 120, 120];
const UNSERVED_COLOUR: [u8; 3] = [70, 70, 70];

impl Measured {
    /// Measures a frame at what is `visible`, where it is `valid`.
    #[must_use]
    pub fn new(visible: &Visible, frame: &ShadowFrame, setting: &Setting, valid: &[bool]) -> Self {
        // Ask the uniforms that the picture was drawn with.
        let (camera, origin) = (&setting.camera, setting.origin);
        let measure = |(pixel, valid): (usize, &bool)| {
            let hit = visible.pixel(pixel).filter(|_| *valid)?;
            let view = serving(frame, camera, origin, hit.position, hit.normal)?;
            footprint_at(&frame.uniforms.views[view], frame.map.side, camera, origin, hit.position, hit.normal)
        };
        let points: Vec<_> = valid.par_iter().enumerate().map(measure).collect();
        // Sum up.
        let spread_of = |figure: fn(&PointFootprint) -> f64| {
            let mut values: Vec<f64> = points.iter().flatten().map(figure).collect();
            Spread::of(&mut values)
        };
        let judged = valid.iter().filter(|valid| **valid).count();
        let served = points.iter().flatten().count();
        Self {
            pixels_per_texel: spread_of(|point| point.pixels_per_texel),
            perspective: spread_of(|point| point.perspective),
            unserved: (judged - served) as f64 / judged.max(1) as f64,
            valid: valid.to_vec(),
            points,
        }
    }

    /// Texels per pixel as colours of [`antumbra_footprint_colour`], for a picture of this width, one pixel of
    /// [`COARSENESS`]². Three bytes per pixel, row 0 on top.
    #[must_use]
    pub fn paint(&self, width: usize) -> Vec<u8> {
        let paint = |pixel: usize| match &self.points[pixel] {
            Some(point) => colour(point.texels_per_pixel),
            None if self.valid[pixel] => UNSERVED_COLOUR,
            None => UNJUDGED_COLOUR,
        };
        let rows = (0..self.points.len() / width.max(1)).step_by(COARSENESS);
        rows.flat_map(|row| (0..width).step_by(COARSENESS).map(move |column| row * width + column))
            .flat_map(paint)
            .collect()
    }
}

/// A colour of the scale, in steps, so that pictures compress; 8-bit sRGB.
#[must_use]
pub fn colour(texels_per_pixel: f64) -> [u8; 3] {
    let stepped = ((texels_per_pixel.log2() * STEPS).round() / STEPS).exp2();
    (antumbra_footprint_colour(stepped as f32) * 255.0).round().as_u8vec3().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_tell_few_from_many() {
        let [few, even, many] = [1.0 / 16.0, 1.0, 16.0].map(colour);
        assert!(few[0] > few[2] && many[2] > many[0], "{few:?} {many:?}");
        assert!(even.iter().all(|channel| *channel > 240), "{even:?}");
        assert_eq!(colour(1e-9), few, "the scale ends");
        assert_eq!(colour(0.0), [89; 3], "none is grey");
    }

    #[test]
    fn pictures_are_coarse() {
        let point = PointFootprint {
            texels_per_pixel: 1.0,
            pixels_per_texel: 1.0,
            perspective: 1.0,
            projection: 1.0,
            area: 1.0,
        };
        let measured = Measured {
            points: vec![Some(point), None, None, None, None, None, None, Some(point), None],
            valid: vec![true, false, true, false, false, false, false, true, false],
            pixels_per_texel: None,
            perspective: None,
            unserved: 0.0,
        };
        // Three by three: rows and columns 0 and 2.
        let expected = [colour(1.0), UNSERVED_COLOUR, UNJUDGED_COLOUR, UNJUDGED_COLOUR];
        assert_eq!(measured.paint(3), expected.concat());
    }
}
