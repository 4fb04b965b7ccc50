//! The light.

use glam::DVec3;

use crate::error::{FitError, coordinate, finite};

/// A light. Directions are unit vectors; lengths nearer than 0.001 to 1 are normalised, others are refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Parallel light: the sun.
    Directional {
        /// The direction in which light travels (from the sun to the ground).
        travel: DVec3,
    },
    /// Light from a point into a cone.
    Spot {
        /// Position, world space.
        position: DVec3,
        /// Axis of the cone, along which light travels.
        travel: DVec3,
        /// Angle from the axis to the side of the cone, radians, 0 to π/2.
        half_angle: f64,
        /// Distance at which it ends, world units.
        range: f64,
    },
    /// Light from a point in all directions.
    Point {
        /// Position, world space.
        position: DVec3,
        /// Distance at which it ends, world units.
        range: f64,
    },
}

/// How far from 1 the length of a direction may be: f32 directions that were interpolated or rotated for long drift by
/// less; a direction that somebody forgot to normalise is farther off.
const UNIT_TOLERANCE: f64 = 1e-3;

impl Light {
    /// Checks every field and normalises directions.
    pub(crate) fn validate(&self) -> Result<Self, FitError> {
        match *self {
            Self::Directional { travel } => Ok(Self::Directional { travel: unit(travel)? }),
            Self::Spot { position, travel, half_angle, range } => {
                position_and_range(position, range)?;
                if !(half_angle > 0.0 && half_angle < core::f64::consts::FRAC_PI_2) {
                    let legal = "greater than 0 and less than pi/2";
                    return Err(FitError::OutOfRange { field: "light.half_angle", value: half_angle, legal });
                }
                Ok(Self::Spot { position, travel: unit(travel)?, half_angle, range })
            }
            Self::Point { position, range } => {
                position_and_range(position, range)?;
                Ok(*self)
            }
        }
    }

    /// The travel of a directional light; other lights are not served yet.
    pub(crate) fn directional(&self) -> Result<DVec3, FitError> {
        let value = match *self {
            Self::Directional { travel } => return Ok(travel),
            Self::Spot { .. } => "a spot light",
            Self::Point { .. } => "a point light",
        };
        Err(FitError::NotYet { field: "light", value, legal: "directional lights" })
    }
}

fn unit(travel: DVec3) -> Result<DVec3, FitError> {
    for component in travel.to_array() {
        finite("light.travel", component)?;
    }
    let length = travel.length();
    if (length - 1.0).abs() > UNIT_TOLERANCE {
        return Err(FitError::NotUnit { field: "light.travel", length });
    }
    Ok(travel / length)
}

fn position_and_range(position: DVec3, range: f64) -> Result<(), FitError> {
    for component in position.to_array() {
        coordinate("light.position", component)?;
    }
    coordinate("light.range", range)?;
    if range > 0.0 {
        return Ok(());
    }
    Err(FitError::OutOfRange { field: "light.range", value: range, legal: "greater than 0" })
}
