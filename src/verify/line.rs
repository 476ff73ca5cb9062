//! A ray as a device had it.

use glam::DVec3;

use crate::geometry::math::wide;

/// Components below this count as this: the distance to a plane is then finite.
const SMALLEST_COMPONENT: f64 = 1e-60;

/// A ray of a kernel, whose numbers are exactly those that the kernel had.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// How far the direction's squared length is from one.
    pub(super) bend: f64,
}

impl Line {
    pub(super) fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        Self::exact(wide(origin), wide(direction))
    }

    pub(super) fn exact(origin: DVec3, direction: DVec3) -> Self {
        // The square is off by no more than 2⁻⁵⁰ for directions of about unit length.
        let bend = (1.0 - direction.length_squared()).abs() + f64::EPSILON * 4.0;
        Self { origin, direction, bend }
    }

    /// One over the direction.
    pub(super) fn inverse(&self) -> DVec3 {
        let size = self.direction.abs().max(DVec3::splat(SMALLEST_COMPONENT));
        1.0 / size.copysign(self.direction)
    }
}
