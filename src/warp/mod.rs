//! How ray coordinates are laid out on a map: one homography, and the strengths that the papers choose for it.

pub use crate::math::homography;
pub(crate) mod bend;
pub(crate) mod sight;
pub mod trapezoid;
pub(crate) mod window;
