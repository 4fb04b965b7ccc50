//! antumbra turns *camera + light + what the scene holds* into *light matrices + WGSL*, and leaves the drawing to the engine.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![allow(
    clippy::cast_possible_truncation,
    reason = "narrowing to f32 and to small indices is what the last stage is for"
)]

mod aliasing;
mod camera;
pub mod encoding;
mod error;
mod fit;
mod focus;
mod frame;
#[cfg(feature = "wgpu")]
pub mod gpu;
mod light;
mod light_space;
mod math;
mod remix;
mod report;
mod scene;
mod technique;
pub mod techniques;
#[cfg(feature = "naga")]
pub mod transpile;
mod warp;
pub mod wgsl;

#[cfg(feature = "lab")]
pub mod lab;

pub use camera::{Camera, ClipDepth, DEFAULT_VIEWPORT, Projection};
pub use error::FitError;
pub use fit::bias::Bias;
pub use frame::{
    CullVolume, Footprint, MAX_CULL_PLANES, MAX_LEFT_OUT, MAX_VIEWS, Pcf, ShadowFrame, ShadowUniforms, ShadowView,
    TexelSize, ViewUniforms, WgslKey,
};
pub use light::Light;
pub use remix::{Encoding, Remix, Stabilise, Warp};
pub use report::{LeftOut, Part, Why};
pub use scene::{Aabb, DepthRange, MAX_SIDE, MapBudget, Object, Scene};
pub use technique::{FitInput, ShadowTechnique};
