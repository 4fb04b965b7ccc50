//! What the scene holds, as far as shadows care: bounds.

use glam::DVec3;

use crate::error::{FitError, LARGEST, coordinate};

/// An axis-aligned box, world space. A box may be flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates; nowhere less than `min`.
    pub max: DVec3,
}

impl Aabb {
    /// The box that holds nothing: the legal way to say "no casters" or "no receivers".
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box from `min` to `max`.
    #[must_use]
    pub const fn new(min: DVec3, max: DVec3) -> Self {
        Self { min, max }
    }

    /// The smallest box around points; [`EMPTY`](Self::EMPTY) for none. A NaN stays, for `fit` to refuse by name.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| Self {
            min: DVec3::select(point.cmpge(bounds.min) | bounds.min.is_nan_mask(), bounds.min, point),
            max: DVec3::select(point.cmple(bounds.max) | bounds.max.is_nan_mask(), bounds.max, point),
        })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True for [`EMPTY`](Self::EMPTY).
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::EMPTY
    }

    /// Middle of the box.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.min + (self.max - self.min) * 0.5
    }

    /// Half of its size along each axis.
    #[must_use]
    pub fn half_size(&self) -> DVec3 {
        (self.max - self.min) * 0.5
    }

    fn validate(&self, min: &'static str, max: &'static str) -> Result<(), FitError> {
        if self.is_empty() {
            return Ok(());
        }
        for (low, high) in self.min.to_array().into_iter().zip(self.max.to_array()) {
            coordinate(min, low)?;
            coordinate(max, high)?;
            if low > high {
                let legal = "min <= max on every axis (or Aabb::EMPTY)";
                return Err(FitError::NotOrdered {
                    lower: min,
                    lower_value: low,
                    upper: max,
                    upper_value: high,
                    legal,
                });
            }
        }
        Ok(())
    }
}

/// One object of the engine, for bounds that are tighter than the scene's. It is taken for one caster, that does not
/// lie above itself as the light sees it ([`Prefilter::dark`](crate::Prefilter::dark) is left out where no objects
/// overlap): give what does in parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Object {
    /// Its bounds, world space.
    pub bounds: Aabb,
    /// Whether it throws shadows.
    pub casts: bool,
}

/// A range of eye depths, world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// Nearest eye depth, ±1e15.
    pub near: f64,
    /// Farthest eye depth, not less than `near`; at most 1e15, or infinite.
    pub far: f64,
}

/// What the scene holds. Bounds must contain what they speak of: a caster outside them may lose its shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene<'a> {
    /// Bounds of everything that throws shadows, wherever it is (outside the view as well).
    pub casters: Aabb,
    /// Bounds of everything that may be in shadow.
    pub receivers: Aabb,
    /// The engine's objects, all that cast among them, or none: tighter near planes for O(objects) time.
    pub objects: &'a [Object],
    /// The eye depths that are visible at all (the shadow distance, or the range of last frame's depth buffer).
    pub visible_depth: Option<DepthRange>,
    /// Positions of surfaces that are seen, world space: a few hundred, spread evenly over the picture (pixels of last
    /// frame's depth buffer). They steer how strong a warp is, and nothing else: no shadow is lost where they are old,
    /// few, or wrong. None is fine.
    pub visible_points: &'a [DVec3],
}

/// Visible points that weigh as much as knowing nothing does: of a body, of a slice, of a range of depths. Fewer trust
/// single pixels; more ask for more points than move the result. Measured with the predictor of warps: a few hundred
/// should decide nearly alone; the body remains for what they have not seen.
pub(crate) const ENOUGH_SAMPLES: f64 = 8.0;

impl Scene<'_> {
    /// A scene of which only the bounds are known, and everything casts and receives.
    #[must_use]
    pub const fn within(bounds: Aabb) -> Self {
        Self { casters: bounds, receivers: bounds, objects: &[], visible_depth: None, visible_points: &[] }
    }

    pub(crate) fn validate(&self) -> Result<(), FitError> {
        self.casters.validate("scene.casters.min", "scene.casters.max")?;
        self.receivers.validate("scene.receivers.min", "scene.receivers.max")?;
        for object in self.objects {
            object.bounds.validate("scene.objects.bounds.min", "scene.objects.bounds.max")?;
        }
        let Some(DepthRange { near, far }) = self.visible_depth else { return Ok(()) };
        coordinate("scene.visible_depth.near", near)?;
        if far > LARGEST && far < f64::INFINITY {
            let (field, legal) = ("scene.visible_depth.far", "-1e15 to 1e15, or infinity");
            return Err(FitError::OutOfRange { field, value: far, legal });
        }
        if far.is_nan() {
            return Err(FitError::NotFinite { field: "scene.visible_depth.far", value: far });
        }
        if near <= far {
            return Ok(());
        }
        Err(FitError::NotOrdered {
            lower: "scene.visible_depth.near",
            lower_value: near,
            upper: "scene.visible_depth.far",
            upper_value: far,
            legal: "near <= far",
        })
    }
}

/// The texels a light may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapBudget {
    /// Side of one map, texels, 1 to 16384.
    pub side: u32,
    /// Array layers, 1 to 256: one for each map, unless maps share them ([`Share`](crate::Share)).
    pub layers: u32,
    /// Views at most, 1 to [`MAX_VIEWS`](crate::MAX_VIEWS).
    pub views: u32,
}

/// Largest side of a map: the largest 2-D texture that current adapters offer.
pub const MAX_SIDE: u32 = 16_384;

impl MapBudget {
    /// One map of `side × side` texels.
    #[must_use]
    pub const fn one(side: u32) -> Self {
        Self { side, layers: 1, views: 1 }
    }

    pub(crate) fn validate(&self) -> Result<(), FitError> {
        let check = |field, value: u32, max: u32, legal| {
            if (1..=max).contains(&value) {
                return Ok(());
            }
            Err(FitError::OutOfRange { field, value: f64::from(value), legal })
        };
        check("map.side", self.side, MAX_SIDE, "1 to 16384 texels")?;
        check("map.layers", self.layers, 256, "1 to 256")?;
        check("map.views", self.views, 8, "1 to 8")
    }
}
