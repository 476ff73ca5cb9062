//! The intersection of a ray and a sphere, in f32. The WGSL twin is `intersect_sphere` in `shaders/scene/sphere.wgsl`, line
//! by line.

use glam::Vec3;

use super::query::{NO_HIT, RayF32};

/// The distance to the first point of the sphere in front of the ray's origin, or [`NO_HIT`]. From inside, this is the
/// far side.
#[inline]
#[must_use]
pub fn intersect_sphere(ray: &RayF32, [x, y, z, radius]: [f32; 4]) -> f32 {
    let to_center = Vec3::new(x, y, z) - ray.origin;
    let b = to_center.dot(ray.direction);
    let foot_to_center = to_center - b * ray.direction;
    let discriminant = radius * radius - foot_to_center.dot(foot_to_center);
    let c = to_center.dot(to_center) - radius * radius;
    let half_chord = discriminant.max(0.0).sqrt();
    let from_foot = if c > 0.0 { -half_chord } else { half_chord };
    let is_sum = b * from_foot >= 0.0;
    let t = if is_sum { b + from_foot } else { c / (b - from_foot) };
    if discriminant >= 0.0 && t > 0.0 { t } else { NO_HIT }
}
