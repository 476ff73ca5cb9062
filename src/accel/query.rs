//! What a traversal is asked, and what it answers.

use glam::Vec3;

use crate::image::NO_ID;

/// The distance of a miss, as in kernels, which have no infinity.
pub const NO_HIT: f32 = 1e30;

/// A ray in the scene's frame, in f32, as kernels have it. It starts in the scene's box, or where it
/// enters it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayF32 {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit length, up to rounding.
    pub direction: Vec3,
}

/// The nearest sphere so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance along the ray; [`NO_HIT`] for a miss.
    pub t: f32,
    /// Index of the sphere in input order; [`NO_ID`] for a miss.
    pub id: u32,
}

impl Nearest {
    /// Nothing yet.
    pub const NONE: Self = Self { t: NO_HIT, id: NO_ID };

    /// Takes the sphere `id` at distance `t`, if that is nearer; of equal distances the smaller id wins,
    /// so that the answer does not depend on the order of the spheres.
    #[inline]
    pub fn offer(&mut self, t: f32, id: u32) {
        if t < self.t || (t <= self.t && id < self.id) {
            *self = Self { t, id };
        }
    }
}
