//! The queries of a traversal: a ray and the nearest hit.

use glam::Vec3;

use crate::image::NO_ID;

/// The distance of a miss, as in kernels, which have no infinity.
pub const NO_HIT: f32 = 1e30;

/// A ray in the scene's frame, in f32, as in kernels. It starts in the scene's inflated box, or where it enters that
/// box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayF32 {
    /// The start of the ray.
    pub origin: Vec3,
    /// The direction; unit length, up to rounding.
    pub direction: Vec3,
}

/// The nearest hit so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance along the ray; [`NO_HIT`] for a miss.
    pub t: f32,
    /// Index of the sphere in input order; [`NO_ID`] for a miss.
    pub id: u32,
}

impl Nearest {
    /// The initial value: no hit.
    pub const NONE: Self = Self { t: NO_HIT, id: NO_ID };

    /// Replaces the hit by the sphere `id` at distance `t` if that is nearer; at equal distances the smaller id wins,
    /// so that the result does not depend on the order of the spheres.
    #[inline]
    pub fn offer(&mut self, t: f32, id: u32) {
        if t < self.t || (t <= self.t && id < self.id) {
            *self = Self { t, id };
        }
    }
}
