//! What a texel stores and how it is read: the Rust twins of the shaders, in f32 as they are.

pub mod blur;
pub mod convolution;
pub mod depth;
pub mod exponential;
pub mod footprint;
pub mod moments;
pub mod split;
pub mod variance;
