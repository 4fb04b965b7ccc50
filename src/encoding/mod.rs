//! What a texel stores and how it is read: the Rust twins of the shaders, in f32 as they are, and the stage of a remix.

pub mod blur;
pub mod convolution;
pub mod depth;
pub mod exponential;
pub mod eye_blur;
pub mod footprint;
pub mod grazing;
pub mod moments;
pub mod pcf;
pub mod pixel;
pub mod read;
pub mod split;
pub mod spread;
pub(crate) mod stage;
pub mod summed;
pub mod variance;
