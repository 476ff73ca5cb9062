//! Spheres.

use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use crate::image::color::LinearRgb;
use crate::scene::material::{Material, SurfaceProperties};

/// A sphere in world space that has not been checked. [`crate::Scene`] checks it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sphere {
    /// Centre, in scene units.
    pub center: [f64; 3],
    /// Radius, in scene units.
    pub radius: f64,
    /// Surface colour.
    pub color: LinearRgb,
    /// The surface's response to light, which matters only for pictures with lighting.
    pub surface: SurfaceProperties,
}

/// The reason why a sphere is not valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct SphereError(String);

impl Sphere {
    /// A matt, opaque sphere.
    #[must_use]
    pub fn new(center: [f64; 3], radius: f64, color: LinearRgb) -> Self {
        Self { center, radius, color, surface: SurfaceProperties::default() }
    }

    /// The sphere with another material.
    #[must_use]
    pub fn with_material(mut self, material: Material) -> Self {
        self.surface.material = material;
        self
    }

    /// The sphere with another opacity.
    #[must_use]
    pub fn with_opacity(mut self, opacity: f32) -> Self {
        self.surface.opacity = opacity;
        self
    }

    /// Checks that the centre and the radius are in range.
    ///
    /// # Errors
    /// Returns an error if the centre or the radius is out of range.
    pub fn check(&self) -> Result<(), SphereError> {
        let [x, y, z] = self.center;
        check([x, y, z, self.radius])
    }
}

/// Checks that a centre (x, y, z) and a radius are in range.
///
/// # Errors
/// Returns an error if one of them is not.
pub fn check([x, y, z, radius]: [f64; 4]) -> Result<(), SphereError> {
    let center = [x, y, z];
    // `contains` is false for NaN.
    let in_range = |x: &f64| (-MAX_LENGTH..=MAX_LENGTH).contains(x);
    if !center.iter().all(in_range) {
        return Err(SphereError(format!(
            "its center is {center:?}; every coordinate must be finite and at most {MAX_LENGTH:e} in size"
        )));
    }
    if !(MIN_LENGTH..=MAX_LENGTH).contains(&radius) {
        let range = format!("greater than 0, and between {MIN_LENGTH:e} and {MAX_LENGTH:e}");
        return Err(SphereError(format!("its radius is {radius:?}; a radius must be finite, {range}")));
    }
    Ok(())
}
