//! The laboratory: scenes, ray-traced truth, metrics, renderers and reports (feature `lab`).
pub mod gpu;
pub mod scene;
