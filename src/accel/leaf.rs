//! Tests of the spheres of one leaf. The WGSL twin is `shaders/accel/leaf.wgsl`.

use super::query::{NO_HIT, Nearest, RayF32};
use super::sphere::intersect_sphere;

/// Updates `nearest` with the nearest sphere of a leaf. Ids ascend within a leaf, so `<` prefers the smaller id at
/// equal distances, and a single call of `offer` is enough.
#[inline]
pub(super) fn offer_leaf(
    spheres: &[[f32; 4]],
    ids: &[u32],
    first: u32,
    count: u32,
    ray: &RayF32,
    nearest: &mut Nearest,
) {
    let mut t = NO_HIT;
    let mut shape_index = first;
    for i in first..first + count {
        let found = intersect_sphere(ray, spheres[i as usize]);
        if found < t {
            t = found;
            shape_index = i;
        }
    }
    if t < NO_HIT {
        nearest.offer(t, ids[shape_index as usize]);
    }
}

/// Whether the ray hits a sphere of a leaf before `t_max`.
#[inline]
pub(super) fn any_in_leaf(
    spheres: &[[f32; 4]],
    first: u32,
    count: u32,
    ray: &RayF32,
    t_max: f32,
) -> bool {
    (first..first + count).any(|i| intersect_sphere(ray, spheres[i as usize]) < t_max)
}
