//! The laboratory: scenes, ray-traced truth, metrics, renderers and reports (feature `lab`).
pub mod report;
pub mod scene;
