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
    let test = |[x, y, z, radius]: [f32; 4]| intersect(&ray, wide([x, y, z]), radius.into());
    let nearest = search.nearest(&ray, |sphere| test(sphere).map(|(t, _)| t))?;
    let (t, normal) = test(nearest.sphere)?;
    Some(Hit { t, id: nearest.id, normal })
}
