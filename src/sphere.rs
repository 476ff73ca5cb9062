//! The one primitive.

use crate::color::LinearRgb;

/// A sphere in world space, as a caller gives it. [`crate::Scene`] checks it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, in scene units.
    pub center: [f64; 3],
    /// Radius, in scene units.
    pub radius: f64,
    /// Surface colour.
    pub color: LinearRgb,
}

impl Sphere {
    /// A sphere from its three parts.
    #[must_use]
    pub const fn new(center: [f64; 3], radius: f64, color: LinearRgb) -> Self {
        Self { center, radius, color }
    }
}
