//! What a caller can get wrong, said so that it can be put right: the field, its value, and what is legal.

use core::fmt;

/// A broken precondition of [`ShadowTechnique::fit`](crate::ShadowTechnique::fit) or of an input's constructor.
///
/// "There is nothing to shadow" is *not* an error: that is an `Ok` frame without views and with a reason in
/// [`ShadowFrame::left_out`](crate::ShadowFrame::left_out).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// A number that must be finite is NaN or infinite.
    NotFinite {
        /// The field, as a path from the input (`camera.projection.near`).
        field: &'static str,
        /// The offending value.
        value: f64,
    },
    /// A number lies outside its legal range.
    OutOfRange {
        /// The field, as a path from the input.
        field: &'static str,
        /// The offending value.
        value: f64,
        /// The legal range, in words or as an interval.
        legal: &'static str,
    },
    /// Two numbers that must be ordered are not.
    NotOrdered {
        /// The field that must be the smaller one.
        lower: &'static str,
        /// Its value.
        lower_value: f64,
        /// The field that must be the larger one.
        upper: &'static str,
        /// Its value.
        upper_value: f64,
        /// What is legal, in words.
        legal: &'static str,
    },
    /// A direction is zero or too far from unit length to be a rounding error.
    NotUnit {
        /// The field, as a path from the input.
        field: &'static str,
        /// Its length.
        length: f64,
    },
    /// A camera matrix is not a rotation and a translation.
    NotRigid {
        /// The field, as a path from the input.
        field: &'static str,
        /// Largest deviation of its Gram matrix from the identity; for a mirrored frame, its determinant.
        deviation: f64,
    },
    /// A matrix is not one of the projections that are recognised.
    NotAProjection {
        /// The field, as a path from the input.
        field: &'static str,
        /// The entry that rules it out (column-major index).
        entry: usize,
        /// Its value.
        value: f64,
        /// What is legal, in words.
        legal: &'static str,
    },
    /// A legal request that this version does not serve yet.
    NotYet {
        /// The field, as a path from the input.
        field: &'static str,
        /// What was asked for.
        value: &'static str,
        /// What is served today.
        legal: &'static str,
    },
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { field, value } => write!(f, "{field} is {value}; legal: a finite number"),
            Self::OutOfRange { field, value, legal } => write!(f, "{field} is {value}; legal: {legal}"),
            Self::NotOrdered { lower, lower_value, upper, upper_value, legal } => {
                write!(f, "{lower} is {lower_value} and {upper} is {upper_value}; legal: {legal}")
            }
            Self::NotUnit { field, length } => {
                write!(f, "{field} has length {length}; legal: a unit vector, to within 0.001")
            }
            Self::NotRigid { field, deviation } => {
                write!(
                    f,
                    "{field} deviates from a rotation by {deviation}; legal: a right-handed rotation and a translation, \
                     to within 0.001"
                )
            }
            Self::NotAProjection { field, entry, value, legal } => {
                write!(f, "{field} has entry {entry} = {value}; legal: {legal}")
            }
            Self::NotYet { field, value, legal } => write!(f, "{field} is {value}; served today: {legal}"),
        }
    }
}

impl core::error::Error for FitError {}

/// `value` if it is finite, else the error that names `field`.
pub(crate) fn finite(field: &'static str, value: f64) -> Result<f64, FitError> {
    if value.is_finite() { Ok(value) } else { Err(FitError::NotFinite { field, value }) }
}

/// Largest coordinate, length or depth, world units. f64 still tells an eighth of a unit apart there, and no product of
/// the fit overflows f32; one light-month in metres is less.
pub(crate) const LARGEST: f64 = 1e15;

/// `value` if it is finite and no larger than [`LARGEST`], else the error that names `field`.
pub(crate) fn coordinate(field: &'static str, value: f64) -> Result<f64, FitError> {
    if finite(field, value)?.abs() <= LARGEST {
        return Ok(value);
    }
    Err(FitError::OutOfRange { field, value, legal: "-1e15 to 1e15" })
}

/// Nothing for an option that is finite and from `low` to `high`, else the error that names `field`.
pub(crate) fn within(
    field: &'static str,
    value: f32,
    [low, high]: [f64; 2],
    legal: &'static str,
) -> Result<(), FitError> {
    let value = finite(field, f64::from(value))?;
    if (low..=high).contains(&value) { Ok(()) } else { Err(FitError::OutOfRange { field, value, legal }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every variant names the field, the value and what is legal: the texts are part of the interface.
    #[test]
    fn texts() {
        let cases = [
            (FitError::NotFinite { field: "a.b", value: f64::NAN }, "a.b is NaN; legal: a finite number"),
            (
                FitError::OutOfRange { field: "map.side", value: 0.0, legal: "1 to 16384" },
                "map.side is 0; legal: 1 to 16384",
            ),
            (
                FitError::NotOrdered {
                    lower: "near",
                    lower_value: 2.0,
                    upper: "far",
                    upper_value: 1.0,
                    legal: "near < far",
                },
                "near is 2 and far is 1; legal: near < far",
            ),
            (
                FitError::NotUnit { field: "light.travel", length: 0.0 },
                "light.travel has length 0; legal: a unit vector, to within 0.001",
            ),
            (
                FitError::NotRigid { field: "camera.world_from_view", deviation: 0.5 },
                "camera.world_from_view deviates from a rotation by 0.5; legal: a right-handed rotation and a translation, \
                 to within 0.001",
            ),
            (
                FitError::NotAProjection { field: "clip_from_view", entry: 3, value: 1.0, legal: "0" },
                "clip_from_view has entry 3 = 1; legal: 0",
            ),
            (
                FitError::NotYet { field: "light", value: "a point light", legal: "directional lights" },
                "light is a point light; served today: directional lights",
            ),
        ];
        for (error, text) in cases {
            assert_eq!(error.to_string(), text);
        }
    }
}
