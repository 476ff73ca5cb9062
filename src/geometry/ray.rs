//! Rays and their hits.

use glam::DVec3;

/// A ray: a half-line, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point where the ray starts.
    pub origin: DVec3,
    /// The direction, of unit length.
    pub direction: DVec3,
}

impl Ray {
    /// The point at distance `t` from the origin.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// The nearest intersection of a ray with a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin, along the ray, in scene units. It is greater than zero.
    pub t: f64,
    /// Index of the sphere, in input order.
    pub id: u32,
    /// Unit normal of the sphere at the hit. It points away from the centre, even if the ray starts inside and hits the
    /// far side.
    pub normal: DVec3,
}
