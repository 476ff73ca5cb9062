//! An orthonormal basis from two arbitrary vectors.

use glam::DVec3;

use crate::geometry::math::unit;

/// The smallest sine of the angle between the two vectors. Below it, the direction of `u` is mostly rounding error.
const MIN_SINE: f64 = 1e-9;

/// Three unit vectors at right angles, right-handed, with `w = u × v`.
///
/// For a camera, `u` points right, `v` up and `w` backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrthonormalBasis {
    u: DVec3,
    v: DVec3,
    w: DVec3,
}

impl OrthonormalBasis {
    /// The basis with `w = a/|a|`, `u = (b × w)/|b × w|` and `v = w × u`.
    ///
    /// `a` and `b` need be neither unit vectors nor perpendicular. See Shirley and Morley, *Realistic Ray Tracing*,
    /// second edition, "Orthonormal bases". One Gram-Schmidt step on `u` is added, because the cross product of nearly
    /// parallel vectors is not quite perpendicular to `w`.
    ///
    /// `None` if a vector is zero or not finite, or if the two are parallel (within 10⁻⁹ radians).
    #[must_use]
    pub fn from_vectors(a: impl Into<DVec3>, b: impl Into<DVec3>) -> Option<Self> {
        let w = unit(a.into())?;
        let across = unit(b.into())?.cross(w);
        if across.length() < MIN_SINE {
            return None;
        }
        let u = unit(across)?;
        let u = unit(u - w * u.dot(w))?;
        Some(Self { u, v: w.cross(u), w })
    }

    /// The first axis. For a camera, it points right.
    #[must_use]
    pub fn u(&self) -> DVec3 {
        self.u
    }

    /// The second axis. For a camera, it points up.
    #[must_use]
    pub fn v(&self) -> DVec3 {
        self.v
    }

    /// The third axis. For a camera, it points backwards, against the direction of view.
    #[must_use]
    pub fn w(&self) -> DVec3 {
        self.w
    }
}
