//! The binary tree: a simple structure that serves as an independent check of the others.
//!
//! Nodes follow Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs" (2009): each holds the boxes of
//! both children, so that reading one node allows two box tests. Spheres are split in half by number along the longest
//! axis of their centres. The tree is therefore perfect: its depth can be computed, and the index of every node is
//! known before the tree is built.

use glam::Vec3;

use super::extent::{Extent, Item};
use super::outliers::Margins;
use super::tree_check::{self, Child, Target, Tree, TreeError, TreeStatistics};
use crate::parallel::both;

/// The largest number of spheres in a leaf.
pub const BINARY_LEAF: u32 = 4;

/// The largest number of levels of a tree, and the size of the kernel's stack: 4 · 2³⁰ spheres are more than there are
/// ids.
pub const BINARY_LEVELS: u32 = 30;

/// The value of `count` that marks a child as an inner node.
pub const BINARY_INNER: u32 = u32::MAX;

/// The number of spheres from which a second thread is worth its cost.
const PARALLEL: usize = 1 << 13;

/// One child of a node: 32 bytes, or two `vec4u`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct BinaryChild {
    /// Corner of the child's box with the smallest coordinates.
    pub low: [f32; 3],
    /// Index of the child's node, or index of the leaf's first sphere in leaf order.
    pub link: u32,
    /// Corner of the child's box with the largest coordinates.
    pub high: [f32; 3],
    /// [`BINARY_INNER`], or the number of spheres of the leaf: 0 to [`BINARY_LEAF`]. Zero occurs only in a root that
    /// lacks a child.
    pub count: u32,
}

impl BinaryChild {
    const EMPTY: Self = Self { low: [0.0; 3], link: 0, high: [0.0; 3], count: 0 };
}

/// A node of 64 bytes, which consists of its two children.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(transparent)]
pub struct BinaryNode(pub [BinaryChild; 2]);

/// A tree whose nodes have two children, and the order of the spheres in its leaves.
///
/// Node 0 is the root; the left child of a node is the next node. A tree without spheres is one node with two empty
/// leaves, so kernels need no special case.
#[derive(Clone, Debug, PartialEq)]
pub struct BinaryTree {
    pub(super) nodes: Vec<BinaryNode>,
    pub(super) ids: Vec<u32>,
    pub(super) levels: u32,
    margin: f32,
}

impl BinaryTree {
    /// Builds the tree of spheres (centre x, y, z in the scene's frame, radius). Each box contains its spheres inflated
    /// by `margin`. The same spheres give the same tree, to the bit.
    #[must_use]
    pub fn build(spheres: &[[f32; 4]], margin: f32) -> Self {
        let mut items = Item::all(spheres, &Margins::one(margin));
        // The smallest number of halvings k with ⌈n/2ᵏ⌉ ≤ 4; each halving is a level.
        let mut halvings = 0;
        while items.len().div_ceil(1 << halvings) > BINARY_LEAF as usize {
            halvings += 1;
        }
        let node_count = ((1_usize << halvings) - 1).max(1);
        let mut nodes = vec![BinaryNode([BinaryChild::EMPTY; 2]); node_count];
        if halvings == 0 {
            if !items.is_empty() {
                nodes[0].0[0] = leaf(&mut items, 0);
            }
        } else {
            inner(&mut nodes, 0, &mut items, 0);
        }
        let ids = items.iter().map(|item| item.id).collect();
        Self { nodes, ids, levels: halvings.max(1), margin }
    }

    /// All nodes, as kernels read them.
    #[must_use]
    pub fn nodes(&self) -> &[BinaryNode] {
        &self.nodes
    }

    /// For each index in leaf order, the index of the sphere in input order; ascending within a leaf.
    #[must_use]
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// The number of nodes on the longest path from the root to a leaf's parent, both included: ⌈log₂(n/4)⌉, and at
    /// least one.
    #[must_use]
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Checks the tree against the spheres it was built from, which are in input order.
    ///
    /// # Errors
    /// Returns an error if the tree is not valid; the error describes the first problem.
    pub fn validate(&self, spheres: &[[f32; 4]]) -> Result<(), TreeError> {
        tree_check::validate(self, spheres, &Margins::one(self.margin))
    }

    /// The size of the tree, and the expected cost of tracing a ray.
    #[must_use]
    pub fn statistics(&self) -> TreeStatistics {
        tree_check::statistics(self)
    }
}

fn child(extent: Extent, link: usize, count: u32) -> BinaryChild {
    // There are fewer than 2³² spheres in a scene, and fewer nodes in a tree.
    let link = link as u32;
    BinaryChild { low: extent.low.to_array(), link, high: extent.high.to_array(), count }
}

fn leaf(items: &mut [Item], first: usize) -> BinaryChild {
    items.sort_unstable_by_key(|item| item.id);
    child(Item::extents(items).0, first, items.len() as u32)
}

/// Builds a perfect subtree over `items`, whose first element has the index `first` in leaf order. The subtree has as
/// many nodes as `nodes`, whose first element has the index `at`. Returns the child record for the parent.
fn inner(nodes: &mut [BinaryNode], at: usize, items: &mut [Item], first: usize) -> BinaryChild {
    let axis = Item::extents(items).1.longest_axis();
    let half = items.len().div_ceil(2);
    Item::select(items, half, axis);
    let large = items.len() >= PARALLEL;
    let (before, after) = items.split_at_mut(half);
    let Some((node, below)) = nodes.split_first_mut() else {
        return BinaryChild::EMPTY;
    };
    let (left_at, right_at) = (at + 1, at + 1 + below.len() / 2);
    node.0 = if below.is_empty() {
        [leaf(before, first), leaf(after, first + half)]
    } else {
        let (left, right) = below.split_at_mut(below.len() / 2);
        let (left, right) = both(
            large,
            || inner(left, left_at, before, first),
            || inner(right, right_at, after, first + half),
        );
        [left, right]
    };
    let [left, right] = node.0;
    let low = Vec3::from(left.low).min(right.low.into());
    let high = Vec3::from(left.high).max(right.high.into());
    BinaryChild { low: low.into(), link: at as u32, high: high.into(), count: BINARY_INNER }
}

impl Tree for BinaryTree {
    const BYTES_PER_NODE: usize = size_of::<BinaryNode>();
    const MAX_LEVELS: u32 = BINARY_LEVELS;
    const MAX_IN_LEAF: u32 = BINARY_LEAF;

    fn node_count(&self) -> usize {
        self.nodes.len()
    }

    fn ids(&self) -> &[u32] {
        &self.ids
    }

    fn levels(&self) -> u32 {
        self.levels
    }

    fn children(&self, node: usize) -> impl Iterator<Item = Child> {
        let children = self.nodes[node].0;
        children.into_iter().enumerate().filter(|(_, child)| child.count > 0).map(
            |(slot, child)| {
                let target = match child.count {
                    BINARY_INNER => Target::Inner(child.link),
                    count => Target::Leaf(child.link, count),
                };
                let bounds = [child.low, child.high].map(|corner| corner.map(f64::from));
                Child { slot: slot as u32, bounds, target }
            },
        )
    }
}
