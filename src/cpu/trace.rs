//! The nearest hit. The WGSL twin is `shaders/primary/trace.wgsl`.

use super::search::Search;
use super::sphere::intersect;
use crate::geometry::math::wide;
use crate::geometry::ray::{Hit, Ray};

/// The nearest hit in front of the ray's origin; of several spheres at the same distance, that with the smallest id.
/// `None` for a miss. With a reference to a scene, every sphere is tested.
#[must_use]
pub fn trace<'a>(search: impl Into<Search<'a>>, ray_in_world: &Ray) -> Option<Hit> {
    let search = search.into();
    let ray = Ray { origin: ray_in_world.origin - search.scene().origin(), ..*ray_in_world };
    let nearest = search
        .nearest(&ray, |_, [x, y, z, radius]| intersect(&ray, wide([x, y, z]), radius.into()))?;
    Some(Hit { t: nearest.t, id: nearest.id, normal: nearest.hit })
}
