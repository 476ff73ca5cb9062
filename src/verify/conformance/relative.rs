//! A shape relative to an exact ray.

use std::ops::Deref;

use glam::DVec3;

use super::moves::Moves;
use super::relative_cone::RelativeCone;
use super::relative_sphere::RelativeSphere;
use crate::scene::Shape;

/// A shape relative to a ray.
#[derive(Clone, Copy, Debug)]
pub(super) enum Seen {
    Sphere(RelativeSphere),
    Cone(RelativeCone),
}

impl Seen {
    /// A shape relative to a ray. The direction must have unit length.
    pub(super) fn new(origin: DVec3, direction: DVec3, shape: Shape) -> Self {
        match shape {
            Shape::Sphere(sphere) => Self::Sphere(RelativeSphere::new(origin, direction, sphere)),
            Shape::Cone(cone) => Self::Cone(RelativeCone::new(origin, direction, &cone)),
        }
    }
}

impl Deref for Seen {
    type Target = dyn Moves;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Sphere(sphere) => sphere,
            Self::Cone(cone) => cone,
        }
    }
}
