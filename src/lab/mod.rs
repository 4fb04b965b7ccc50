//! The laboratory: scenes, ray-traced truth, metrics, renderers and reports (feature `lab`).
pub mod bvh;
pub mod case;
pub mod gltf;
pub mod metrics;
pub mod scene;
pub mod truth;
