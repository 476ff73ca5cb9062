//! Errors of spheres and appearances that do not make a scene.

use super::cone::ConeError;
use super::sphere::SphereError;

/// The reason why spheres and an appearance do not make a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A sphere is out of range.
    #[error("sphere {index}: {error}")]
    Sphere {
        /// Index in input order.
        index: usize,
        /// The problem of the sphere.
        error: SphereError,
    },
    /// A cone or cylinder is out of range.
    #[error("cone {index}: {error}")]
    Cone {
        /// Index among the cones, in input order.
        index: usize,
        /// The problem of the cone.
        error: ConeError,
    },
    /// There is not enough memory for all spheres.
    #[error("there is not enough memory for {count} spheres, which need {} bytes", count * 16)]
    Memory {
        /// The number of spheres given.
        count: usize,
    },
    /// The origin of the frame, the appearance or the number of spheres is not valid.
    #[error("{0}")]
    Invalid(String),
}

impl SceneError {
    /// An error for a sphere whose palette index is out of range.
    pub(super) fn color(index: usize, colors: usize) -> Self {
        Self::Invalid(format!(
            "sphere {index} has no color: its index is out of range; the palette has {colors} colors"
        ))
    }

    /// An error for a sphere that has the number NaN, for which a colour map has no colour.
    pub(super) fn scalar(index: usize) -> Self {
        Self::Invalid(format!("sphere {index} has the number NaN, which has no color"))
    }
}
