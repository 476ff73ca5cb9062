//! The plain two-child tree: the simple second opinion.
//!
//! Nodes after Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs" (2009): each holds
//! the boxes of both children, so that one node is read for two tests. Spheres are halved by number along
//! the longest axis of their centres, so the tree is perfect: its depth is a theorem, and the place of every
//! node is known before it is built.

use glam::Vec3;

use super::extent::{Extent, Item};
use super::tree_check::{self, Child, Target, Tree, TreeError, TreeStatistics};
use crate::parallel::both;

/// How many spheres a leaf may hold.
pub const BINARY_LEAF: u32 = 4;

/// How many levels a tree may have, and the size of the kernel's stack: 4 · 2³⁰ spheres are more than there
/// are ids.
pub const BINARY_LEVELS: u32 = 30;

/// The count of a child that is a node.
pub const BINARY_INNER: u32 = u32::MAX;

/// From so many spheres on, two threads are worth their start.
const PARALLEL: usize = 1 << 13;

/// One child of a node, in 32 bytes, or two `vec4u`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct BinaryChild {
    /// The box's least corner.
    pub low: [f32; 3],
    /// Index of the node, or place of the leaf's first sphere.
    pub link: u32,
    /// The box's greatest corner.
    pub high: [f32; 3],
    /// [`BINARY_INNER`], or how many spheres the leaf has: 0 to [`BINARY_LEAF`]. None only in a root that
    /// lacks a child.
    pub count: u32,
}

impl BinaryChild {
    const EMPTY: Self = Self { low: [0.0; 3], link: 0, high: [0.0; 3], count: 0 };
}

/// A node of 64 bytes: its two children.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(transparent)]
pub struct BinaryNode(pub [BinaryChild; 2]);

/// A tree of nodes with two children, and the spheres' order in its leaves.
///
/// Node 0 is the root; a node's left child follows it at once. Without spheres there is one node with two
/// empty leaves, so a kernel needs no special case.
#[derive(Clone, Debug, PartialEq)]
pub struct BinaryTree {
    pub(super) nodes: Vec<BinaryNode>,
    pub(super) ids: Vec<u32>,
    pub(super) levels: u32,
    margin: f32,
}

impl BinaryTree {
    /// Builds the tree of spheres (centre, radius) in the scene's frame, each box larger than its spheres
    /// by `margin`. The same spheres make the same tree, to the bit.
    #[must_use]
    pub fn build(spheres: &[[f32; 4]], margin: f32) -> Self {
        let mut items = Item::all(spheres, margin);
        // The least number of halvings, of which each is a level, that makes leaves of four; ⌈n/2ᵏ⌉ ≤ 4.
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

    /// All nodes, as the kernel reads them.
    #[must_use]
    pub fn nodes(&self) -> &[BinaryNode] {
        &self.nodes
    }

    /// Of each place in leaf order, the index of its sphere in input order; ascending within a leaf.
    #[must_use]
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// How many nodes are on the longest way from the root, both ends included: ⌈log₂(n/4)⌉, and at least
    /// one.
    #[must_use]
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Checks the tree against the spheres, in input order, that it was built from.
    ///
    /// # Errors
    /// The first thing that is wrong with it.
    pub fn validate(&self, spheres: &[[f32; 4]]) -> Result<(), TreeError> {
        tree_check::validate(self, spheres, self.margin)
    }

    /// What it takes, and what a ray pays for it.
    #[must_use]
    pub fn statistics(&self) -> TreeStatistics {
        tree_check::statistics(self)
    }
}

fn child(extent: Extent, link: usize, count: u32) -> BinaryChild {
    // A scene has fewer than 2³² spheres, and a tree fewer nodes.
    let link = link as u32;
    BinaryChild { low: extent.low.to_array(), link, high: extent.high.to_array(), count }
}

fn leaf(items: &mut [Item], first: usize) -> BinaryChild {
    items.sort_unstable_by_key(|item| item.id);
    child(Item::extents(items).0, first, items.len() as u32)
}

/// Builds a perfect tree of `nodes`, whose first has the index `at`, over `items`, whose first has the place
/// `first`; says what a parent must know of it.
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
    const MOST_LEVELS: u32 = BINARY_LEVELS;
    const MOST_IN_LEAF: u32 = BINARY_LEAF;

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
