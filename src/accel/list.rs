//! The search without a structure, which tests every sphere. The WGSL twin is `shaders/accel/list.wgsl`.

use super::query::{NO_HIT, Nearest, RayF32};
use super::sphere::intersect_sphere;

/// Updates `nearest` with the nearest of the spheres, whose ids ascend.
pub fn find_nearest(spheres: &[[f32; 4]], ids: &[u32], ray: &RayF32, nearest: &mut Nearest) {
    let mut best = (NO_HIT, 0);
    for (shape_index, sphere) in spheres.iter().enumerate() {
        let t = intersect_sphere(ray, *sphere);
        if t < best.0 {
            best = (t, shape_index);
        }
    }
    if best.0 < NO_HIT {
        nearest.offer(best.0, ids[best.1]);
    }
}

/// Whether the ray hits any sphere before `t_max`.
#[must_use]
pub fn find_any(spheres: &[[f32; 4]], ray: &RayF32, t_max: f32) -> bool {
    spheres.iter().any(|sphere| intersect_sphere(ray, *sphere) < t_max)
}
