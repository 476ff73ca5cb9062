//! An orthonormal basis from two arbitrary vectors.

use glam::DVec3;

use crate::geometry::math::unit;

/// The smallest sine of the angle between the two vectors; below it, the direction of `u` is mostly rounding error.
const MIN_SINE: f64 = 1e-9;

/// Three unit vectors at right angles, right-handed: `w = u × v`.
///
/// For a camera, `u` points right, `v` up and `w` backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrthonormalBasis {
    u: DVec3,
    v: DVec3,
    w: DVec3,
}

/// Why two vectors do not define a basis.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BasisError {
    /// A component of the named vector is NaN or infinite.
    #[error("{name} is {value}; every component must be finite")]
    NotFinite {
        /// Name of the vector.
        name: &'static str,
        /// The vector as given.
        value: DVec3,
    },
    /// The named vector is zero.
    #[error("{name} is the zero vector, which has no direction")]
    Zero {
        /// Name of the vector.
        name: &'static str,
    },
    /// The two vectors are parallel.
    #[error("{a} and {b} are parallel; tilt one of them")]
    Parallel {
        /// The first vector.
        a: &'static str,
        /// The second vector.
        b: &'static str,
    },
}

impl OrthonormalBasis {
    /// The basis with `w = a/|a|`, `u = (b × w)/|b × w|` and `v = w × u`.
    ///
    /// `a` and `b` need be neither unit nor perpendicular. See Shirley and Morley, *Realistic Ray
    /// Tracing*, second edition, "Orthonormal bases"; added here is one Gram-Schmidt step on `u`,
    /// because the cross product of nearly parallel vectors is not quite perpendicular to `w`.
    ///
    /// # Errors
    /// Returns an error if a vector is zero or not finite, or if the two are parallel (within 10⁻⁹ radians).
    pub fn from_vectors(a: impl Into<DVec3>, b: impl Into<DVec3>) -> Result<Self, BasisError> {
        Self::from_named_vectors("a", a.into(), "b", b.into())
    }

    /// The basis of a camera at `eye` that looks at `look_at`: `a = eye − look_at`, `b = up`.
    ///
    /// # Errors
    /// Returns the same errors as [`OrthonormalBasis::from_vectors`]; the messages name the eye, the target and `up`.
    pub fn looking_at(
        eye: impl Into<DVec3>,
        look_at: impl Into<DVec3>,
        up: impl Into<DVec3>,
    ) -> Result<Self, BasisError> {
        let (eye, look_at) = (eye.into(), look_at.into());
        for (name, value) in [("the eye", eye), ("the look-at point", look_at)] {
            if !value.is_finite() {
                return Err(BasisError::NotFinite { name, value });
            }
        }
        // Halved, so that the difference of two finite points is finite.
        let backwards = eye * 0.5 - look_at * 0.5;
        Self::from_named_vectors("eye minus look-at point", backwards, "up", up.into())
    }

    fn from_named_vectors(
        a_name: &'static str,
        a: DVec3,
        b_name: &'static str,
        b: DVec3,
    ) -> Result<Self, BasisError> {
        let w = named_unit(a_name, a)?;
        let b = named_unit(b_name, b)?;
        let across = b.cross(w);
        if across.length() < MIN_SINE {
            return Err(BasisError::Parallel { a: a_name, b: b_name });
        }
        let parallel = BasisError::Parallel { a: a_name, b: b_name };
        let u = unit(across).ok_or(parallel)?;
        let u = unit(u - w * u.dot(w)).ok_or(parallel)?;
        Ok(Self { u, v: w.cross(u), w })
    }

    /// The first axis; for a camera, it points right.
    #[must_use]
    pub fn u(&self) -> DVec3 {
        self.u
    }

    /// The second axis; for a camera, it points up.
    #[must_use]
    pub fn v(&self) -> DVec3 {
        self.v
    }

    /// The third axis; for a camera, it points backwards, against the direction of view.
    #[must_use]
    pub fn w(&self) -> DVec3 {
        self.w
    }
}

fn named_unit(name: &'static str, value: DVec3) -> Result<DVec3, BasisError> {
    if !value.is_finite() {
        return Err(BasisError::NotFinite { name, value });
    }
    unit(value).ok_or(BasisError::Zero { name })
}
