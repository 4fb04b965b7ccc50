//! The laboratory: scenes, ray-traced truth, metrics, renderers and reports (feature `lab`).
pub mod raster;
pub mod report;
pub mod scene;
pub mod shapes;
pub mod sparse_city;
pub mod treeline;
pub mod viewpoints;
pub mod bvh;
pub mod case;
pub mod gltf;
pub mod metrics;
pub mod scene;
pub mod truth;
