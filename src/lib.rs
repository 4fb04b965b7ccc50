//! antumbra turns *camera + light + what the scene holds* into *light matrices + WGSL*,
//! and leaves the drawing to the engine.
//!
//! # Scope
//! Shadow mapping in real time: how texels are laid out over what is in view, what they store, how they are read
//! without acne or leaks, and what a scene does not need. Every technique is measured against ray-traced truth (feature
//! `lab`).
//!
//! # Simplifications
//! - One light at a time; engines call [`ShadowTechnique::fit`] once per frame and light.
//! - The scene is known by bounds, not by triangles. Bounds are promises.
//! - This version serves directional light with one map, uniform ([`techniques::ssm`], [`techniques::fsm`]) or warped
//!   ([`techniques::psm`], [`techniques::tsm`], [`techniques::lispsm`], [`techniques::minimax`],
//!   [`techniques::least_error`]), or with several, split by depth ([`techniques::pssm`], [`techniques::cascades`],
//!   [`techniques::smra`], [`techniques::smra_plus`]). Maps store depths, compared by filters of texels, of the pixel
//!   ([`Pcf::Pixel`]) or as wide as penumbras are ([`Encoding::Soft`]), or moments of them ([`techniques::vsm`] to
//!   [`techniques::msm_hausdorff`]).
//!
//! # Not here
//! A renderer, a scene graph, a device. The core never names a GPU; with feature `wgpu` the module `gpu` brings
//! textures, bind groups and passes as middleware, and still owns no device, submits nothing and polls nothing.
//!
//! # One frame
//! Camera → focus body → slices → warp → window → ray coordinates → clip space → view → uniforms → shader, in one
//! direction.
//!
//! ```
//! use antumbra::{Aabb, Camera, FitInput, Light, MapBudget, Scene, ShadowTechnique, techniques, wgsl};
//! use glam::{DMat4, DVec3};
//!
//! // When options change: the shader.
//! let technique = techniques::fsm();
//! let shader: String = wgsl::module(technique.wgsl_key(), wgsl::Bindings { group: 2, first: 0 });
//!
//! // Every frame: the fit. Pure, no allocation, no GPU.
//! let eye = Camera::look_at(DVec3::new(0.0, 2.0, 18.0), DVec3::new(0.0, 3.0, 0.0), DVec3::Y);
//! let frame = technique.fit(&FitInput {
//!     camera: Camera::perspective(eye, 0.8, 16.0 / 9.0, 0.1, f64::INFINITY),
//!     light: Light::Directional { travel: DVec3::new(0.6, -0.8, 0.0) },
//!     scene: Scene::within(Aabb::new(DVec3::new(-20.0, 0.0, -20.0), DVec3::new(20.0, 9.0, 20.0))),
//!     map: MapBudget::one(2048),
//!     origin: DVec3::ZERO,
//!     previous: None,
//! })?;
//!
//! // Upload `frame.uniforms`; draw casters into each of `frame.views`; call `antumbra_visibility` in the shader.
//! let upload: &[u8] = bytemuck::bytes_of(&frame.uniforms);
//! assert_eq!(frame.views.len(), 1);
//! assert_eq!(frame.wgsl, technique.wgsl_key());
//! for cut in &frame.left_out {
//!     println!("{cut}");
//! }
//! # let _ = (shader, upload);
//! # Ok::<(), antumbra::FitError>(())
//! ```
//!
//! # Conventions
//! Each row is a test (`tests/conventions.rs`).
//!
//! | what | convention |
//! |---|---|
//! | world and view space | right-handed; the view looks along −z; any direction may be up |
//! | render space | world − `origin`: what emitted matrices and shader positions are relative to |
//! | vectors, matrices | column vectors; a matrix is named `to_from` |
//! | clip space of a map | x, y ∈ [−1, 1], z ∈ [0, 1], 0 nearest the light; w = 1 (uniform) or ≥ 1 in view (warped) |
//! | texture coordinates | within a view's viewport u = x/2 + ½, v = ½ − y/2: row 0 is on top |
//! | depth | linear along the light: `depth_from_render` equals clip z before the division by w |
//! | `travel` | the unit vector along which light travels |
//! | winding | a triangle that is counter-clockwise seen from the light is counter-clockwise in the map |
//! | angles, lengths | radians, world units |
//! | precision | f64 in, f64 inside, narrowed to f32 once, relative to `origin` |
#![cfg_attr(docsrs, feature(doc_cfg))]

/// The manual's example is compiled and run with the others.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Manual;

pub mod aliasing;
mod camera;
mod content;
pub mod encoding;
mod error;
mod fit;
mod focus;
mod frame;
#[cfg(feature = "wgpu")]
pub mod gpu;
mod grazing;
mod key;
mod light;
mod light_space;
mod math;
mod remix;
mod report;
mod scene;
pub mod split;
mod technique;
pub mod techniques;
mod texel;
#[cfg(feature = "naga")]
pub mod transpile;
pub mod warp;
pub mod wgsl;

#[cfg(feature = "lab")]
pub mod lab;

pub use camera::{Camera, ClipDepth, DEFAULT_VIEWPORT, Projection};
pub use content::Content;
pub use encoding::eye_blur::{EyeBlur, EyeBlurUniforms};
pub use encoding::stage::{Encoding, Prefilter, Radius, SUN_ANGLE};
pub use error::FitError;
pub use fit::bias::Bias;
pub use fit::share::Share;
pub use fit::snap::Stabilise;
pub use frame::{
    CullVolume, Footprint, MAX_CULL_PLANES, MAX_LEFT_OUT, MAX_VIEWS, MapShape, Pcf, Select, ShadowFrame,
    ShadowUniforms, ShadowView, TexelSize, ViewUniforms, WgslKey,
};
pub use grazing::Grazing;
pub use light::Light;
pub use remix::{DepthLaw, Remix};
pub use report::{LeftOut, Part, Why};
pub use scene::{Aabb, DepthRange, MAX_SIDE, MapBudget, Object, Scene};
pub use split::{DepthSplits, Scheme, Split};
pub use technique::{FitInput, ShadowTechnique};
pub use texel::{BlurUniforms, CONVOLUTION_TERMS, MomentFormat, MomentKind, Moments, SUMMED_TEXELS, Texel};
pub use warp::{Focus, Warp};
