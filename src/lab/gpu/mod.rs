//! The GPU renderer: the library's shaders, through the library's wgpu layer, on any adapter.
//!
//! [`Gpu`] is the device, [`GpuScene`] a scene on it, [`Renderer`] the pipelines of one shader key. A picture takes
//! three passes: casters into the map, the camera's depth (reversed, so that it stays precise far away), receivers into
//! a mask. [`Renderer::race`] runs two passes written by hand beside the library's, turn by turn.

mod baseline;
mod clock;
mod pipelines;
mod projection;
mod readback;
mod render;
mod scene;
mod turns;

use core::fmt;

use glam::DVec3;

use crate::gpu::GpuError;

pub use baseline::Race;
pub use clock::{Clock, PassTimes};
pub use readback::{read_depth, read_moments, read_sums};
pub use render::{GpuImage, RenderOptions, Renderer};
pub use scene::GpuScene;
pub use turns::{Entrant, Turns, draw_in_turns};

/// A device of the laboratory's own, for drawing without a window.
#[derive(Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
}

/// There is no adapter to draw with, or it gave no device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GpuUnavailable {
    /// What wgpu says.
    pub reason: String,
}

impl fmt::Display for GpuUnavailable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no GPU: {} (Mesa's software Vulkan driver, lavapipe, is enough)", self.reason)
    }
}

impl core::error::Error for GpuUnavailable {}

/// Why a picture could not be drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GpuFailure {
    /// Maps, frame and renderer do not fit together.
    Maps(GpuError),
    /// The frame was fitted to another origin of render space than the scene was uploaded with.
    Origin {
        /// Origin of the scene, world space.
        scene: DVec3,
        /// Origin of the frame, world space.
        frame: DVec3,
    },
    /// A part of a scene model that cannot be drawn.
    Scene {
        /// The field, as a path from the model.
        field: &'static str,
        /// The offending value.
        value: u64,
        /// The least value that is too large, or the value it must have.
        legal: u64,
    },
    /// The camera's picture is larger than the device can draw.
    Picture {
        /// Longer side of the picture, pixels.
        side: u32,
        /// Largest side, pixels.
        largest: u32,
    },
    /// The device was lost, or did not answer.
    Device {
        /// What wgpu says.
        reason: String,
    },
}

impl fmt::Display for GpuFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Maps(error) => error.fmt(f),
            Self::Origin { scene, frame } => {
                write!(f, "the frame's origin is {frame}; legal: the origin of the uploaded scene, {scene}")
            }
            Self::Scene { field, value, legal } => write!(f, "{field} is {value}; legal: within {legal}"),
            Self::Picture { side, largest } => {
                write!(f, "camera.viewport has a side of {side}; legal: at most {largest} pixels on this device")
            }
            Self::Device { reason } => write!(f, "the device failed: {reason}"),
        }
    }
}

impl core::error::Error for GpuFailure {}

impl From<GpuError> for GpuFailure {
    fn from(error: GpuError) -> Self {
        Self::Maps(error)
    }
}

impl GpuFailure {
    pub(crate) fn device(reason: impl fmt::Display) -> Self {
        Self::Device { reason: reason.to_string() }
    }
}

impl Gpu {
    /// Opens the best adapter, a software one if there is no other. `WGPU_BACKEND` and `WGPU_ADAPTER_NAME` choose.
    ///
    /// # Errors
    /// There is no adapter.
    pub fn new() -> Result<Self, GpuUnavailable> {
        // Timestamps, and formats of moments.
        Self::with_features(
            wgpu::Features::TIMESTAMP_QUERY
                | wgpu::Features::FLOAT32_FILTERABLE
                | wgpu::Features::TEXTURE_FORMAT_16BIT_NORM
                | wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES,
        )
    }

    /// The same, with those of the `wanted` features that the adapter has, and no others.
    ///
    /// # Errors
    /// There is no adapter.
    pub fn with_features(wanted: wgpu::Features) -> Result<Self, GpuUnavailable> {
        let unavailable = |reason: &dyn fmt::Display| GpuUnavailable { reason: reason.to_string() };
        // Take the adapter that the environment names, else the fastest.
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = if std::env::var_os("WGPU_ADAPTER_NAME").is_some() {
            pollster::block_on(wgpu::util::initialize_adapter_from_env(&instance, None))
        } else {
            pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::HighPerformance,
                ..Default::default()
            }))
        };
        let adapter = adapter.map_err(|error| unavailable(&error))?;
        // Everything it can hold.
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("antumbra laboratory"),
            required_features: adapter.features() & wanted,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| unavailable(&error))?;
        Ok(Self { device, queue, info: adapter.get_info() })
    }

    /// Name of the adapter.
    #[must_use]
    pub fn adapter(&self) -> &str {
        &self.info.name
    }

    /// The API it is driven by: `vulkan`, `metal`, `dx12`.
    #[must_use]
    pub fn backend(&self) -> String {
        self.info.backend.to_string()
    }

    /// True for drivers that draw on the CPU.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether passes can be timed by the GPU itself.
    #[must_use]
    pub fn has_timestamps(&self) -> bool {
        self.device.features().contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Waits until everything that was submitted is done.
    pub(crate) fn wait(&self) -> Result<(), GpuFailure> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map(|_| ()).map_err(GpuFailure::device)
    }
}
