//! The nearest hit, found by testing every sphere. The WGSL twin is `shaders/primary/trace.wgsl`.

use glam::DVec3;

use super::sphere::intersect;
use crate::geometry::ray::{Hit, Ray};
use crate::scene::Scene;

/// The nearest hit in front of the ray's origin; of several spheres at the same distance, that with the smallest id.
/// `None` for a miss.
#[must_use]
pub fn trace(scene: &Scene, ray_in_world: &Ray) -> Option<Hit> {
    let ray = Ray { origin: ray_in_world.origin - scene.origin(), ..*ray_in_world };
    let mut nearest: Option<Hit> = None;
    for (id, &[x, y, z, radius]) in scene.spheres().iter().enumerate() {
        let center = DVec3::new(x.into(), y.into(), z.into());
        let Some((t, normal)) = intersect(&ray, center, radius.into()) else {
            continue;
        };
        // Ids ascend, so `<` prefers the smaller id at equal distances.
        if nearest.is_none_or(|hit| t < hit.t) {
            nearest = Some(Hit { t, id: id as u32, normal });
        }
    }
    nearest
}
