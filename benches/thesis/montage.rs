//! Pictures side by side with their names, as JPEG.

use antumbra::lab::metrics::{heat_map, mask_from_bytes};
use antumbra::lab::truth::{NO_TRIANGLE, Truth};
use glam::{DVec3, Vec3};
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};

/// Quality of the pictures, 1 to 100: less shows blocks at shadow edges, more doubles the files.
const QUALITY: u8 = 82;

/// Light that surfaces get without the sun: 0 would hide what stands in shadow, 1 the shadows.
const AMBIENT: f32 = 0.3;

/// Colours of the ground (what faces up), of everything else, and of the sky; linear.
const GROUND: Vec3 = Vec3::new(0.55, 0.60, 0.42);
const WALL: Vec3 = Vec3::new(0.72, 0.66, 0.58);
const SKY: Vec3 = Vec3::new(0.60, 0.72, 0.88);

/// Exponent from bytes to light: sRGB's curve is within 0.04 of it.
const GAMMA: f32 = 2.2;

/// Rows of pixels between pictures, and of the strip that a name stands in.
const GAP: usize = 4;
const STRIP: usize = 22;

/// Side of a dot of a letter, pixels.
const DOT: usize = 2;

/// Letters of five by seven dots, rows from the top as bits, leftmost the highest.
const LETTERS: [(char, [u8; 7]); 27] = [
    ('0', [14, 17, 19, 21, 25, 17, 14]),
    ('1', [4, 12, 4, 4, 4, 4, 14]),
    ('2', [14, 17, 1, 2, 4, 8, 31]),
    ('4', [2, 6, 10, 18, 31, 2, 2]),
    ('5', [31, 16, 30, 1, 1, 17, 14]),
    ('8', [14, 17, 17, 14, 17, 17, 14]),
    ('A', [14, 17, 17, 31, 17, 17, 17]),
    ('C', [14, 17, 16, 16, 16, 17, 14]),
    ('D', [30, 17, 17, 17, 17, 17, 30]),
    ('E', [31, 16, 16, 30, 16, 16, 31]),
    ('F', [31, 16, 16, 30, 16, 16, 16]),
    ('G', [14, 17, 16, 19, 17, 17, 15]),
    ('H', [17, 17, 17, 31, 17, 17, 17]),
    ('I', [14, 4, 4, 4, 4, 4, 14]),
    ('L', [16, 16, 16, 16, 16, 16, 31]),
    ('M', [17, 27, 21, 21, 17, 17, 17]),
    ('N', [17, 25, 21, 19, 17, 17, 17]),
    ('O', [14, 17, 17, 17, 17, 17, 14]),
    ('P', [30, 17, 17, 30, 16, 16, 16]),
    ('R', [30, 17, 17, 30, 20, 18, 17]),
    ('S', [15, 16, 16, 14, 1, 1, 30]),
    ('T', [31, 4, 4, 4, 4, 4, 4]),
    ('U', [17, 17, 17, 17, 17, 17, 14]),
    ('V', [17, 17, 17, 17, 17, 10, 4]),
    ('W', [17, 17, 17, 21, 21, 27, 17]),
    ('Z', [31, 1, 2, 4, 8, 16, 31]),
    ('+', [0, 4, 4, 31, 4, 4, 0]),
];

/// A picture of three bytes a pixel, row 0 on top.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// Lambert's cosine times what a mask lets through; without a mask everything that faces the light is lit.
    pub(crate) fn shaded(truth: &Truth, mask: Option<&[u8]>, travel: DVec3) -> Self {
        let to_light = -travel.as_vec3();
        let shade = |pixel: usize| {
            if truth.triangle[pixel] == NO_TRIANGLE {
                return srgb(SKY);
            }
            let normal = Vec3::from(truth.normal[pixel]);
            let light = mask.map_or(1.0, |mask| f32::from(mask[pixel]) / f32::from(u8::MAX));
            let colour = if normal.y > 0.9 { GROUND } else { WALL };
            srgb(
                colour * (AMBIENT * (0.75 + 0.25 * normal.y) + (1.0 - AMBIENT) * light * normal.dot(to_light).max(0.0)),
            )
        };
        let (width, height) = (truth.width as usize, truth.height as usize);
        Self { width, height, pixels: (0..width * height).map(shade).collect() }
    }

    /// Where light leaks (orange-red) and where shadow is false (blue).
    pub(crate) fn errors(truth: &Truth, mask: &[u8]) -> Result<Self, String> {
        let bytes = heat_map(&mask_from_bytes(mask), truth).map_err(|error| error.to_string())?;
        let pixels = bytes.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Ok(Self { width: truth.width as usize, height: truth.height as usize, pixels })
    }

    /// Half as wide and high: means of the light of four.
    pub(crate) fn halved(&self) -> Self {
        let (width, height) = (self.width / 2, self.height / 2);
        let light: [f32; 256] = std::array::from_fn(|byte| (byte as f32 / f32::from(u8::MAX)).powf(GAMMA));
        let mean = |index: usize| {
            let at = 2 * (index / width) * self.width + 2 * (index % width);
            let four = [0, 1, self.width, self.width + 1].map(|step| self.pixels[at + step]);
            srgb(
                four.map(|pixel| Vec3::from(pixel.map(|byte| light[usize::from(byte)]))).into_iter().sum::<Vec3>()
                    / 4.0,
            )
        };
        Self { width, height, pixels: (0..width * height).map(mean).collect() }
    }

    /// A part of it, from a corner on.
    pub(crate) fn cropped(&self, [left, top]: [usize; 2], [width, height]: [usize; 2]) -> Self {
        let rows =
            (top..top + height).flat_map(|row| &self.pixels[row * self.width + left..row * self.width + left + width]);
        Self { width, height, pixels: rows.copied().collect() }
    }

    /// In other colours, where there are any: each pixel stays as bright as it was.
    pub(crate) fn tinted(&self, colour: impl Fn(usize) -> Option<[u8; 3]>) -> Self {
        let tint = |(pixel, old): (usize, &[u8; 3])| {
            let grey = f32::from(old[0].max(old[1]).max(old[2])) / f32::from(u8::MAX);
            colour(pixel).map_or(*old, |new| new.map(|channel| (f32::from(channel) * grey).round() as u8))
        };
        Self { pixels: self.pixels.iter().enumerate().map(tint).collect(), ..*self }
    }

    /// The pixel at a place, if it is in the picture.
    pub(crate) fn pixel_at(&self, x: f64, y: f64) -> Option<usize> {
        let inside = (0.0..self.width as f64).contains(&x) && (0.0..self.height as f64).contains(&y);
        inside.then(|| y as usize * self.width + x as usize)
    }

    /// Draws a line as a row of squares, `pen` pixels to all sides; what is outside of the picture is left out.
    pub(crate) fn draw_line(&mut self, from: [f64; 2], to: [f64; 2], pen: f64, colour: [u8; 3]) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let steps = along[0].abs().max(along[1].abs()).ceil().max(1.0);
        let offsets = [-pen, 0.0, pen];
        for step in 0..=steps as usize {
            let share = step as f64 / steps;
            for (x, y) in offsets.iter().flat_map(|x| offsets.iter().map(move |y| (x, y))) {
                if let Some(pixel) = self.pixel_at(from[0] + share * along[0] + x, from[1] + share * along[1] + y) {
                    self.pixels[pixel] = colour;
                }
            }
        }
    }

    /// One above the other, from the left.
    pub(crate) fn above(&self, other: &Self) -> Self {
        let mut whole = Self::blank(self.width.max(other.width), self.height + other.height);
        whole.put(self, [0, 0]);
        whole.put(other, [0, self.height]);
        whole
    }

    fn blank(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![[255; 3]; width * height] }
    }

    fn put(&mut self, other: &Self, [left, top]: [usize; 2]) {
        for (row, pixels) in other.pixels.chunks_exact(other.width).enumerate() {
            let start = (top + row) * self.width + left;
            self.pixels[start..start + other.width].copy_from_slice(pixels);
        }
    }

    /// Writes a name in capitals.
    fn write(&mut self, name: &str, [left, top]: [usize; 2]) {
        for (place, letter) in name.to_uppercase().chars().enumerate() {
            let Some((_, rows)) = LETTERS.iter().find(|(known, _)| *known == letter) else { continue };
            let dots = (0..7).flat_map(|y| (0..5).map(move |x| (x, y))).filter(|(x, y)| rows[*y] >> (4 - x) & 1 == 1);
            for (x, y) in dots {
                for pixel in 0..DOT * DOT {
                    let (x, y) = (left + (6 * place + x) * DOT + pixel % DOT, top + y * DOT + pixel / DOT);
                    if x < self.width {
                        self.pixels[y * self.width + x] = [32; 3];
                    }
                }
            }
        }
    }

    /// As a JPEG file.
    pub(crate) fn encode(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        JpegEncoder::new_with_quality(&mut bytes, QUALITY)
            .write_image(self.pixels.as_flattened(), self.width as u32, self.height as u32, ExtendedColorType::Rgb8)
            .map_err(|error| format!("cannot encode a picture: {error}"))?;
        Ok(bytes)
    }
}

/// Pictures of one size, so many to a row, each below its name.
pub(crate) fn montage(pictures: &[(String, Picture)], columns: usize) -> Picture {
    let (width, height) = pictures.first().map_or((1, 1), |(_, picture)| (picture.width, picture.height));
    let rows = pictures.len().div_ceil(columns);
    let mut whole = Picture::blank(columns * (width + GAP) - GAP, rows * (height + STRIP));
    for (index, (name, picture)) in pictures.iter().enumerate() {
        let [left, top] = [index % columns * (width + GAP), index / columns * (height + STRIP)];
        whole.write(name, [left + GAP, top + (STRIP - 7 * DOT) / 2]);
        whole.put(picture, [left, top + STRIP]);
    }
    whole
}

/// Linear to 8-bit sRGB, near enough for a picture.
fn srgb(colour: Vec3) -> [u8; 3] {
    (colour.clamp(Vec3::ZERO, Vec3::ONE).powf(1.0 / GAMMA) * 255.0).round().as_u8vec3().to_array()
}
