//! Traversal of the binary tree. The WGSL twin is `shaders/accel/binary_tree.wgsl`.

use glam::Vec3;

use super::binary_tree::{BINARY_INNER, BINARY_LEVELS, BinaryChild, BinaryTree};
use super::leaf::{any_in_leaf, offer_leaf};
use super::query::{Nearest, RayF32};
use super::slab::SlabRay;

/// The entry distance of a box that the ray misses; greater than any distance.
pub(crate) const NO_ENTRY: f32 = 2e30;

impl BinaryTree {
    /// Updates `nearest` with the nearest sphere along the ray. `spheres` are in the order of [`BinaryTree::ids`], and
    /// `ids` are their ids in the result.
    ///
    /// # Panics
    /// Panics if there are fewer spheres or ids than in the tree.
    pub fn find_nearest(
        &self,
        spheres: &[[f32; 4]],
        ids: &[u32],
        ray: &RayF32,
        nearest: &mut Nearest,
    ) {
        let slab = SlabRay::new(ray);
        let mut stack = [(0, 0.0); BINARY_LEVELS as usize];
        let mut top = 0;
        let mut index = 0_u32;
        loop {
            let children = &self.nodes[index as usize].0;
            let entries = [0, 1].map(|i| entry(&children[i], &slab));
            let near = usize::from(entries[1] < entries[0]);
            let sides = [near, 1 - near].map(|i| (children[i], entries[i]));
            for (child, entry) in sides {
                if child.count != BINARY_INNER && entry <= nearest.t {
                    offer_leaf(spheres, ids, child.link, child.count, ray, nearest);
                }
            }
            let [near, far] = sides.map(|(child, entry)| {
                if child.count == BINARY_INNER { (child.link, entry) } else { (0, NO_ENTRY) }
            });
            let mut next = near;
            if near.1 > nearest.t {
                next = far;
            } else if far.1 <= nearest.t {
                stack[top] = far;
                top += 1;
            }
            while next.1 > nearest.t {
                if top == 0 {
                    return;
                }
                top -= 1;
                next = stack[top];
            }
            index = next.0;
        }
    }

    /// Whether the ray hits a sphere before `t_max`. `spheres` are in the order of [`BinaryTree::ids`].
    ///
    /// # Panics
    /// Panics if there are fewer spheres than ids.
    #[must_use]
    pub fn find_any(&self, spheres: &[[f32; 4]], ray: &RayF32, t_max: f32) -> bool {
        let slab = SlabRay::new(ray);
        let mut stack = [0; BINARY_LEVELS as usize];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            for child in &self.nodes[stack[top] as usize].0 {
                if entry(child, &slab) > t_max {
                    continue;
                }
                if child.count == BINARY_INNER {
                    stack[top] = child.link;
                    top += 1;
                } else if any_in_leaf(spheres, child.link, child.count, ray, t_max) {
                    return true;
                }
            }
        }
        false
    }
}

/// The distance at which the ray enters the box of a child, or [`NO_ENTRY`].
#[inline]
fn entry(child: &BinaryChild, ray: &SlabRay) -> f32 {
    let a = (Vec3::from(child.low) - ray.origin) * ray.inverse;
    let b = (Vec3::from(child.high) - ray.origin) * ray.inverse;
    let entry = a.min(b).max_element().max(0.0);
    if entry <= a.max(b).min_element() { entry } else { NO_ENTRY }
}
