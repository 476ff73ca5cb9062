//! Position and orientation of a camera.

use glam::{DVec2, DVec3};

use crate::geometry::basis::OrthonormalBasis;
use crate::geometry::bounds::Bounds;
use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH};

/// The position and the orientation of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    origin: DVec3,
    basis: OrthonormalBasis,
}

/// The reason why parameters do not make a camera.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// `up` is parallel to the direction of view, so the roll of the camera is undefined.
    #[error("up {:?} is parallel to the direction of view; tilt it", up.to_array())]
    UpParallelToView {
        /// The vector as given.
        up: DVec3,
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
    /// Another parameter is not valid, or parameters do not go together.
    #[error("{0}")]
    Invalid(String),
}

impl Pose {
    /// The default direction of view: along −z, as in molecule viewers.
    pub(super) const DEFAULT_DIRECTION: [f64; 3] = [0.0, 0.0, -1.0];

    /// A camera at `eye` that looks at `look_at`. `up` fixes the roll, and need be neither a unit vector nor
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
        // Halved, so that points that differ by the smallest number count as the same.
        let backwards = eye * 0.5 - look_at * 0.5;
        if backwards == DVec3::ZERO {
            let eye = eye.to_array();
            let message = "the eye and the look-at point are both at";
            return Err(CameraError::Invalid(format!("{message} {eye:?}; move one of them")));
        }
        let basis = OrthonormalBasis::from_vectors(backwards, up).ok_or(CameraError::UpParallelToView { up })?;
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
        // Finite vectors that are not zero have no basis only if they are parallel.
        let basis = OrthonormalBasis::from_vectors(-direction, up).ok_or(CameraError::UpParallelToView { up })?;
        Ok(Self { origin: eye, basis })
    }

    /// The orientation, at a position relative to the centre of a box.
    pub(super) fn framing(self, bounds: &Bounds, offset: DVec3) -> Result<Self, CameraError> {
        let origin = bounds.center() + offset;
        checked_point("the eye", origin).map_err(|_| {
            let [from, to] = [bounds.min(), bounds.max()].map(|corner| corner.to_array());
            CameraError::Invalid(format!(
                "no camera can frame the scene, which reaches from {from:?} to {to:?}; give an eye, or move the scene"
            ))
        })?;
        Ok(Self { origin, ..self })
    }

    /// The pose, moved by a vector.
    pub(super) fn moved(self, by: DVec3) -> Result<Self, CameraError> {
        let origin = self.origin + by;
        checked_point("the eye", origin)?;
        Ok(Self { origin, ..self })
    }

    /// The vectors of a camera that looks along −w, with a view plane of the given half extent.
    pub(super) fn vectors(&self, half_extent: DVec2, numbers: [f64; 3]) -> CameraVectors {
        let (origin, basis) = (self.origin, self.basis);
        let [right, up] = [basis.u() * half_extent.x, basis.v() * half_extent.y];
        CameraVectors { origin, right, up, forward: -basis.w(), numbers }
    }

    /// A point relative to the camera: the distances to the right and up, and the distance forward.
    pub(super) fn seen(&self, point: DVec3) -> (DVec2, f64) {
        let (toward, basis) = (point - self.origin, self.basis);
        (DVec2::new(toward.dot(basis.u()), toward.dot(basis.v())), -toward.dot(basis.w()))
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

pub(super) fn checked_point(parameter: &str, value: DVec3) -> Result<(), CameraError> {
    // The comparison is false for NaN as well.
    let is_near = value.to_array().iter().all(|x| x.abs() <= MAX_LENGTH);
    if is_near { Ok(()) } else { Err(out_of_range(parameter, value)) }
}

fn out_of_range(parameter: &str, value: DVec3) -> CameraError {
    let value = value.to_array();
    CameraError::Invalid(format!(
        "{parameter} is {value:?}; every component must be finite and at most {MAX_LENGTH:e} in size"
    ))
}

/// Returns an error for a vector that has no direction.
fn checked_direction(parameter: &str, value: DVec3) -> Result<(), CameraError> {
    if !value.is_finite() {
        return Err(out_of_range(parameter, value));
    }
    if value == DVec3::ZERO {
        let message = format!("{parameter} is the zero vector, which has no direction");
        return Err(CameraError::Invalid(message));
    }
    Ok(())
}

/// The vectors in world space and numbers, in f64, that describe a camera of a known kind completely.
///
/// The Rust file and the WGSL part of each camera define the exact meaning of `right`, `up`, `forward` and `numbers`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CameraVectors {
    /// Position of the camera.
    pub origin: DVec3,
    /// Vector from the middle of the view plane to its edge at x = +1.
    pub right: DVec3,
    /// Vector from the middle of the view plane to its edge at y = +1.
    pub up: DVec3,
    /// Vector into the picture.
    pub forward: DVec3,
    /// Further parameters of the camera. Unused ones are zero.
    pub numbers: [f64; 3],
}

impl CameraVectors {
    /// Makes the vectors of a camera from rows in the order of the fields, after the checks that hold for cameras of
    /// every kind.
    pub(crate) fn checked(rows: [DVec3; 5]) -> Result<Self, CameraError> {
        let [origin, right, up, forward, numbers] = rows;
        checked_point("the origin", origin)?;
        for (parameter, value) in [("length of right", right), ("length of up", up), ("length of forward", forward)] {
            // Each is a length in range times a vector of unit length, up to rounding.
            let length = value.length();
            if !(0.5 * MIN_LENGTH..=2.0 * MAX_LENGTH).contains(&length) {
                return Err(CameraError::Length { parameter, value: length });
            }
        }
        // The numbers are lengths, or quotients of two lengths.
        const LARGEST: f64 = 2.0 * MAX_LENGTH * MAX_LENGTH;
        let numbers = numbers.to_array();
        for number in numbers {
            checked_range("number of the camera", number, [-LARGEST, LARGEST])?;
        }
        Ok(Self { origin, right, up, forward, numbers })
    }
}

/// Returns an error for a number that is NaN or not in a range.
pub(super) fn checked_range(parameter: &'static str, value: f64, [low, high]: [f64; 2]) -> Result<f64, CameraError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(CameraError::Range { parameter, value, low, high }) }
}
