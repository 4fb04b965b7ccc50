//! antumbra: real-time shadow mapping.
#[cfg(feature = "lab")]
pub mod lab;
