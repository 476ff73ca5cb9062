//! Position and orientation of a camera.

use glam::DVec3;

use crate::geometry::basis::OrthonormalBasis;
use crate::geometry::bounds::Bounds;
use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH};

/// The position and the orientation of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    origin: DVec3,
    basis: OrthonormalBasis,
}

/// Why parameters do not make a camera.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The eye and the point at which it looks are the same.
    #[error("the eye and the look-at point are both at {:?}; move one of them", eye.to_array())]
    EyeAtTarget {
        /// The point.
        eye: DVec3,
    },
    /// `up` is parallel to the direction of view, so the roll of the camera is undefined.
    #[error("up {:?} is parallel to the direction of view; tilt it", up.to_array())]
    UpParallelToView {
        /// The vector as given.
        up: DVec3,
    },
    /// A vector that must have a direction is zero.
    #[error("{parameter} is the zero vector, which has no direction")]
    Zero {
        /// Name of the parameter.
        parameter: &'static str,
    },
    /// A component of a point or vector is NaN or infinite, or a point lies too far away.
    #[error(
        "{parameter} is {:?}; every component must be finite and at most {MAX_LENGTH:e} in size",
        value.to_array()
    )]
    Vector {
        /// Name of the parameter.
        parameter: &'static str,
        /// The vector as given.
        value: DVec3,
    },
    /// A length is NaN, infinite, zero, negative or too small or large for f32 kernels.
    #[error(
        "the {parameter} is {value:?}; it must be finite, greater than 0, and between {MIN_LENGTH:e} and {MAX_LENGTH:e}"
    )]
    Length {
        /// Name of the parameter.
        parameter: &'static str,
        /// The value as given.
        value: f64,
    },
    /// A number is NaN or out of its range.
    #[error("the {parameter} is {value:?}; it must lie between {low:?} and {high:?}")]
    Range {
        /// Name of the parameter.
        parameter: &'static str,
        /// The value as given.
        value: f64,
        /// The smallest valid value.
        low: f64,
        /// The largest valid value.
        high: f64,
    },
    /// A field of view is not an angle between 0 and π.
    #[error("the vertical field of view is {} degrees; it must lie between 0 and 180", radians.to_degrees())]
    FieldOfView {
        /// The angle as given.
        radians: f64,
    },
    /// The box that must be seen is so large, or so far away, that the camera would be out of range.
    #[error(
        "no camera can frame the scene, which reaches from {:?} to {:?}; give an eye, or move the scene",
        bounds.min().to_array(), bounds.max().to_array()
    )]
    Framing {
        /// The box.
        bounds: Bounds,
    },
    /// Two parameters that exclude each other were given, or one was left out.
    #[error("{message}")]
    Parameters {
        /// Which parameters, and what to do.
        message: &'static str,
    },
}

impl Pose {
    /// The direction of view if none is given: along −z, as in molecule viewers.
    pub(super) const DEFAULT_DIRECTION: [f64; 3] = [0.0, 0.0, -1.0];

    /// A camera at `eye` that looks at `look_at`; `up` fixes the roll and need be neither a unit vector nor
    /// perpendicular.
    ///
    /// # Errors
    /// Returns an error if the two points coincide, `up` is zero or parallel to the view, or a component is NaN,
    /// infinite or more than [`MAX_LENGTH`].
    pub fn looking_at(
        eye: impl Into<DVec3>,
        look_at: impl Into<DVec3>,
        up: impl Into<DVec3>,
    ) -> Result<Self, CameraError> {
        let (eye, look_at, up) = (eye.into(), look_at.into(), up.into());
        checked_point("the eye", eye)?;
        checked_point("the look-at point", look_at)?;
        checked_direction("up", up)?;
        // Halved, so that points apart by the least number are the same.
        let backwards = eye * 0.5 - look_at * 0.5;
        if backwards == DVec3::ZERO {
            return Err(CameraError::EyeAtTarget { eye });
        }
        let basis = OrthonormalBasis::from_vectors(backwards, up)
            .ok_or(CameraError::UpParallelToView { up })?;
        Ok(Self { origin: eye, basis })
    }

    /// A camera at `eye` that looks along `direction`.
    ///
    /// # Errors
    /// Returns the same errors as [`Pose::looking_at`], and an error if `direction` is zero.
    pub fn looking_along(
        eye: impl Into<DVec3>,
        direction: impl Into<DVec3>,
        up: impl Into<DVec3>,
    ) -> Result<Self, CameraError> {
        let (eye, direction, up) = (eye.into(), direction.into(), up.into());
        checked_point("the eye", eye)?;
        checked_direction("the direction", direction)?;
        checked_direction("up", up)?;
        // Two finite vectors that are not zero can only be parallel.
        let basis = OrthonormalBasis::from_vectors(-direction, up)
            .ok_or(CameraError::UpParallelToView { up })?;
        Ok(Self { origin: eye, basis })
    }

    /// The same orientation, at a place relative to the centre of a box.
    pub(super) fn framing(self, bounds: &Bounds, offset: DVec3) -> Result<Self, CameraError> {
        let origin = bounds.center() + offset;
        checked_point("the eye", origin).map_err(|_| CameraError::Framing { bounds: *bounds })?;
        Ok(Self { origin, ..self })
    }

    /// The same orientation, moved by a vector.
    pub(super) fn moved(self, by: DVec3) -> Result<Self, CameraError> {
        let origin = self.origin + by;
        checked_point("the eye", origin)?;
        Ok(Self { origin, ..self })
    }

    /// Position of the camera.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The axes of the camera: u points right, v up and w backwards.
    #[must_use]
    pub fn basis(&self) -> OrthonormalBasis {
        self.basis
    }
}

pub(super) fn checked_point(parameter: &'static str, value: DVec3) -> Result<(), CameraError> {
    // The comparison is false for NaN as well.
    if value.to_array().iter().all(|x| x.abs() <= MAX_LENGTH) {
        Ok(())
    } else {
        Err(CameraError::Vector { parameter, value })
    }
}

/// Returns an error for a vector that has no direction.
fn checked_direction(parameter: &'static str, value: DVec3) -> Result<(), CameraError> {
    if !value.is_finite() {
        return Err(CameraError::Vector { parameter, value });
    }
    if value == DVec3::ZERO {
        return Err(CameraError::Zero { parameter });
    }
    Ok(())
}
