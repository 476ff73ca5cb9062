//! The children of a node of the 8-wide tree that are still to be visited, and their order. The WGSL twin is
//! `shaders/accel/wide_group.wgsl`.

use super::wide_node::WideNode;

/// The inner children of one node that a ray hits and has not visited.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// Index of the node's first inner child.
    first_child: u32,
    /// Mask of the slots that hold inner children.
    inner_mask: u32,
    /// Mask of the children left, in the order of visits.
    left: u32,
}

impl Group {
    /// The group that consists of only the root.
    pub(super) const ROOT: Self = Self { first_child: 0, inner_mask: 0, left: 1 };

    /// The inner children among the slots that the ray hits.
    pub(super) fn of(node: &WideNode, hits: u32, octant: u32) -> Self {
        let inner_mask = node.inner_mask();
        let left = octant_order(hits & inner_mask, octant);
        Self { first_child: node.0[4], inner_mask, left }
    }

    pub(super) fn is_empty(self) -> bool {
        self.left == 0
    }

    /// Index of the node to visit first.
    pub(super) fn first(self, octant: u32) -> u32 {
        let slot = self.left.trailing_zeros() ^ octant;
        self.first_child + (self.inner_mask & ((1 << slot) - 1)).count_ones()
    }

    /// The group without its first node.
    pub(super) fn rest(self) -> Self {
        Self { left: self.left & (self.left - 1), ..self }
    }
}

/// Moves bit s to bit `s ^ octant`: the lowest bit is then the child that a ray of this octant hits first. The WGSL
/// twin is `octant_order` in `shaders/accel/wide_group.wgsl`.
#[inline]
pub(super) fn octant_order(mask: u32, octant: u32) -> u32 {
    let mut mask = mask;
    if octant & 1 != 0 {
        mask = (mask & 0x55) << 1 | mask >> 1 & 0x55;
    }
    if octant & 2 != 0 {
        mask = (mask & 0x33) << 2 | mask >> 2 & 0x33;
    }
    if octant & 4 != 0 {
        mask = (mask & 0x0f) << 4 | mask >> 4;
    }
    mask
}

/// The group of the root in the kernel's format.
#[cfg(all(test, feature = "gpu"))]
pub(crate) const PACKED_ROOT: [u32; 2] =
    [Group::ROOT.first_child, Group::ROOT.left << 24 | Group::ROOT.inner_mask];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_move_to_where_the_octant_sends_them() {
        for octant in 0..8 {
            for mask in 0..256_u32 {
                let expected = (0..8).fold(0, |m, s| m | (mask >> s & 1) << (s ^ octant));
                assert_eq!(octant_order(mask, octant), expected);
            }
        }
    }
}
