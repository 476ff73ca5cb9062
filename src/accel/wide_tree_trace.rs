//! Traversal of the compressed 8-wide tree. The WGSL twin is `shaders/accel/wide_tree.wgsl`.

use super::leaf::{any_in_leaf, offer_leaf};
use super::query::{Nearest, RayF32};
use super::slab::SlabRay;
use super::wide_group::Group;
use super::wide_node::{LEAF_COUNT_SHIFT, LEAF_FIRST, WideNode};
use super::wide_tree::{WIDE_LEVELS, WideTree};

impl WideTree {
    /// Updates `nearest` with the nearest sphere along the ray. `spheres` are in the order of [`WideTree::ids`], and
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
        let slab = SlabRay::for_tree(ray, &self.near_rays());
        let octant = slab.octant();
        let mut stack = [Group::ROOT; WIDE_LEVELS as usize];
        let mut top = 0;
        let mut group = Group::ROOT;
        loop {
            let node = &self.nodes[group.first(octant) as usize];
            let rest = group.rest();
            if !rest.is_empty() {
                stack[top] = rest;
                top += 1;
            }
            let hits = node.hits(&slab, nearest.t);
            for (first, count) in leaves(node, hits) {
                offer_leaf(spheres, ids, first, count, ray, nearest);
            }
            group = Group::of(node, hits, octant);
            if group.is_empty() {
                if top == 0 {
                    return;
                }
                top -= 1;
                group = stack[top];
            }
        }
    }

    /// Whether the ray hits a sphere before `t_max`. `spheres` are in the order of [`WideTree::ids`].
    ///
    /// # Panics
    /// Panics if there are fewer spheres than ids.
    #[must_use]
    pub fn find_any(&self, spheres: &[[f32; 4]], ray: &RayF32, t_max: f32) -> bool {
        let slab = SlabRay::for_tree(ray, &self.near_rays());
        let mut stack = [Group::ROOT; WIDE_LEVELS as usize];
        let mut top = 0;
        let mut group = Group::ROOT;
        loop {
            let node = &self.nodes[group.first(0) as usize];
            let rest = group.rest();
            if !rest.is_empty() {
                stack[top] = rest;
                top += 1;
            }
            let hits = node.hits(&slab, t_max);
            if leaves(node, hits)
                .any(|(first, count)| any_in_leaf(spheres, first, count, ray, t_max))
            {
                return true;
            }
            group = Group::of(node, hits, 0);
            if group.is_empty() {
                if top == 0 {
                    return false;
                }
                top -= 1;
                group = stack[top];
            }
        }
    }
}

/// The index of the first sphere and the length of each leaf that the ray hits.
#[inline]
fn leaves(node: &WideNode, hits: u32) -> impl Iterator<Item = (u32, u32)> {
    let mut left = hits & !node.inner_mask();
    std::iter::from_fn(move || {
        let slot = (left != 0).then_some(left.trailing_zeros() as usize)?;
        left &= left - 1;
        let leaf = u32::from(node.byte(6, slot));
        Some((node.0[5] + (leaf & LEAF_FIRST), leaf >> LEAF_COUNT_SHIFT))
    })
}
