//! What does not fit together: device, maps and frame.

use core::fmt;

use glam::UVec4;

use crate::frame::WgslKey;

/// What does not fit together. One line each: what is there, and what was expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GpuError {
    /// The frame is for another shader text than the maps were made for.
    Key {
        /// The key that the maps were made for.
        expected: WgslKey,
        /// The frame's key.
        actual: WgslKey,
    },
    /// The maps would be larger than the device allows, or empty.
    Side {
        /// The side that was asked for, texels.
        side: u32,
        /// The device's largest side, texels.
        largest: u32,
    },
    /// The frame was fitted for maps of another size: its texture coordinates count texels of those.
    FrameSide {
        /// Side of the maps that the frame was fitted for, texels.
        side: u32,
        /// Side of these maps, texels.
        expected: u32,
    },
    /// The frame has more views than the maps have room for.
    Views {
        /// Views of the frame.
        views: usize,
        /// Most views that the maps hold.
        most: usize,
    },
    /// A view's rectangle or layer lies outside the maps: they were made with fewer layers than the frame has.
    Viewport {
        /// Number of the view.
        view: usize,
        /// Its x, y, width and height, texels.
        viewport: UVec4,
        /// Its layer.
        layer: u32,
        /// Side of the maps, texels.
        side: u32,
        /// Number of their layers.
        layers: u32,
    },
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Key { expected, actual } => {
                write!(f, "frame.wgsl is {actual:?}; legal: the key of these maps, {expected:?}")
            }
            Self::Side { side, largest } => {
                write!(f, "map.side is {side}; legal: 1 to {largest} texels on this device")
            }
            Self::FrameSide { side, expected } => {
                write!(f, "frame.map.side is {side}; legal: the side of these maps, {expected} texels")
            }
            Self::Views { views, most } => {
                write!(f, "frame.views has {views} views; legal: at most {most} in these maps")
            }
            Self::Viewport { view, viewport: at, layer, side, layers } => {
                let [x, y, width, height] = at.to_array();
                let among = if layers > 1 { format!("layers 0 to {}", layers - 1) } else { "layer 0".to_owned() };
                write!(
                    f,
                    "frame.views[{view}].viewport is {width}x{height} texels at ({x}, {y}) of layer {layer}; legal: inside \
                     {among} of {side}x{side} texels"
                )
            }
        }
    }
}

impl core::error::Error for GpuError {}
