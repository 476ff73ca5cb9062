//! Axis-aligned bounds.

use glam::DVec3;

use crate::geometry::ray::Ray;

/// An axis-aligned box in world space, never empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    min: DVec3,
    max: DVec3,
}

impl Bounds {
    /// The bounding box of a sphere.
    #[must_use]
    pub fn of_sphere(center: DVec3, radius: f64) -> Self {
        Self { min: center - radius, max: center + radius }
    }

    /// The box between two opposite corners.
    pub(crate) fn between(min: DVec3, max: DVec3) -> Self {
        Self { min, max }
    }

    /// The smallest box that contains both boxes.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The corner with the smallest coordinates.
    #[must_use]
    pub fn min(&self) -> DVec3 {
        self.min
    }

    /// The corner with the largest coordinates.
    #[must_use]
    pub fn max(&self) -> DVec3 {
        self.max
    }

    /// The centre.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The edge lengths.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// The box with all sides moved outwards.
    pub(crate) fn widened(self, by: f64) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// The distance at which a ray enters the box: 0 if it starts inside, and `None` if it misses the box.
    pub(crate) fn entry(&self, ray: &Ray) -> Option<f64> {
        let (mut near, mut far) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            if direction == 0.0 {
                if origin < self.min[axis] || origin > self.max[axis] {
                    return None;
                }
                continue;
            }
            let a = (self.min[axis] - origin) / direction;
            let b = (self.max[axis] - origin) / direction;
            (near, far) = (near.max(a.min(b)), far.min(a.max(b)));
        }
        (near <= far).then_some(near)
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let ends = [self.min, self.max];
        std::array::from_fn(|i| DVec3::new(ends[i & 1].x, ends[(i >> 1) & 1].y, ends[(i >> 2) & 1].z))
    }
}
