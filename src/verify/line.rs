//! Rays with the numbers that a device used.

use glam::DVec3;

use crate::geometry::math::wide;

/// The smallest magnitude of a component; smaller ones are replaced by it, so that the distance to a plane is finite.
const SMALLEST_COMPONENT: f64 = 1e-60;

/// A ray with exactly the numbers that a kernel used.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// The deviation of the direction's squared length from one.
    pub(super) bend: f64,
}

impl Line {
    pub(super) fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        Self::exact(wide(origin), wide(direction))
    }

    pub(super) fn exact(origin: DVec3, direction: DVec3) -> Self {
        // The computed square is off by at most 2⁻⁵⁰ for directions of about unit length.
        let bend = (1.0 - direction.length_squared()).abs() + f64::EPSILON * 4.0;
        Self { origin, direction, bend }
    }

    /// How far beside the silhouette of a sphere the ray is, as a fraction of its radius.
    pub(super) fn beside_silhouette(&self, [x, y, z, radius]: [f32; 4]) -> f64 {
        let to_center = wide([x, y, z]) - self.origin;
        let foot = to_center.cross(self.direction).length() / self.direction.length();
        let radius = f64::from(radius.abs());
        (foot - radius).abs() / radius
    }

    /// The reciprocal of each component of the direction.
    pub(super) fn inverse(&self) -> DVec3 {
        let size = self.direction.abs().max(DVec3::splat(SMALLEST_COMPONENT));
        1.0 / size.copysign(self.direction)
    }
}
