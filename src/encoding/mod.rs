//! What a texel stores and how it is read: the Rust twins of the shaders, in f32 as they are.

pub mod depth;
pub mod footprint;
pub mod split;
