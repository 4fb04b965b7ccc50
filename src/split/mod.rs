//! Where a view is cut into several maps.

pub mod depth;
pub(crate) mod equal_error;
pub(crate) mod profile;

pub use depth::{DepthSplits, Scheme};

use crate::error::FitError;
use crate::frame::Select;

/// How many maps there are, and what each is for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Split {
    /// One map.
    #[default]
    One,
    /// One map for each of several ranges of eye depth (cascades).
    Depth(DepthSplits),
}

impl Split {
    /// Most maps.
    pub(crate) fn maps(&self) -> u8 {
        match self {
            Self::One => 1,
            Self::Depth(splits) => splits.maps,
        }
    }

    /// How receivers find their map, and whether maps are blended into each other.
    pub(crate) fn selection(&self) -> (Select, bool) {
        match self {
            Self::Depth(splits) if splits.maps > 1 => (splits.select, splits.blend > 0.0),
            _ => (Select::default(), false),
        }
    }

    /// Checks the numbers of its options.
    pub(crate) fn validate(&self) -> Result<(), FitError> {
        match self {
            Self::One => Ok(()),
            Self::Depth(splits) => splits.validate(),
        }
    }
}
