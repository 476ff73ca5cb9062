//! The compressed 8-wide tree: few bytes a sphere and few nodes a ray.

use super::extent::Item;
use super::tree_check::{self, Child, Target, Tree, TreeError, TreeStatistics};
use super::wide_node::{Slot, WIDE_LEAF, WideNode};
use super::wide_tree_build;

/// How many levels a tree may have, and the size of the kernel's stack. `build` proves that no tree has
/// more; a walk leaves at most one entry on the stack for each level but the first.
pub const WIDE_LEVELS: u32 = 16;

/// A tree of nodes with up to eight children, and the spheres' order in its leaves.
///
/// Node 0 is the root; children come after their parents, those of one node one behind the other. Without
/// spheres there is one node without children, so a kernel needs no special case.
#[derive(Clone, Debug, PartialEq)]
pub struct WideTree {
    pub(super) nodes: Vec<WideNode>,
    pub(super) ids: Vec<u32>,
    pub(super) levels: u32,
    margin: f32,
}

impl WideTree {
    /// Builds the tree of spheres (centre, radius) in the scene's frame, each box larger than its spheres
    /// by `margin`.
    ///
    /// Takes time in proportion to n log n whatever the spheres are, and 28 bytes a sphere besides the
    /// tree, which has at most one node and 14 bytes of nodes for each sphere. The same spheres
    /// make the same tree, to the bit, whatever the number of threads.
    #[must_use]
    pub fn build(spheres: &[[f32; 4]], margin: f32) -> Self {
        let mut items = Item::all(spheres, margin);
        let (nodes, ids, levels) = wide_tree_build::build(&mut items);
        Self { nodes, ids, levels, margin }
    }

    /// All nodes, as the kernel reads them.
    #[must_use]
    pub fn nodes(&self) -> &[WideNode] {
        &self.nodes
    }

    /// Of each place in leaf order, the index of its sphere in input order; ascending within a leaf.
    #[must_use]
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// How many nodes are on the longest way from the root, both ends included; at most [`WIDE_LEVELS`].
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

impl Tree for WideTree {
    const BYTES_PER_NODE: usize = size_of::<WideNode>();
    const MOST_LEVELS: u32 = WIDE_LEVELS;
    const MOST_IN_LEAF: u32 = WIDE_LEAF as u32;

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
        let node = self.nodes[node];
        (0..8).filter_map(move |slot| {
            let target = match node.slot(slot) {
                Slot::Empty => return None,
                Slot::Inner(index) => Target::Inner(index),
                Slot::Leaf(first, count) => Target::Leaf(first, count),
            };
            Some(Child { slot: slot as u32, bounds: node.slot_box(slot), target })
        })
    }
}
