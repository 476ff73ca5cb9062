//! The compressed 8-wide tree, which needs few bytes per sphere and few nodes per ray.

use super::extent::Item;
use super::outliers::Margins;
#[cfg(feature = "gpu")]
use super::outliers::NearRays;
use super::wide_node::WideNode;
use super::wide_tree_build;

/// A tree whose nodes have up to eight children, and the order of the spheres in its leaves.
///
/// Node 0 is the root; children come after their parents, and those of one node are consecutive. A tree without spheres
/// is one node without children, so kernels need no special case.
#[derive(Clone, Debug, PartialEq)]
pub struct WideTree {
    pub(super) nodes: Vec<WideNode>,
    pub(super) ids: Vec<u32>,
    pub(super) levels: u32,
    pub(super) margins: Margins,
}

impl WideTree {
    /// Builds the tree of spheres (centre x, y, z in the scene's frame, radius). Each box contains its spheres inflated
    /// by `margin`.
    ///
    /// Takes time proportional to n log n for any spheres, and 28 bytes per sphere in addition to the tree, which has
    /// at most 14 bytes of nodes per sphere and one more node. The same spheres give the same tree, to the bit, for any
    /// number of threads.
    #[must_use]
    pub fn build(spheres: &[[f32; 4]], margin: f32) -> Self {
        Self::build_with(spheres, Margins::one(margin))
    }

    /// Builds the tree with a margin for each sphere.
    pub(super) fn build_with(spheres: &[[f32; 4]], margins: Margins) -> Self {
        let mut items = Item::all(spheres, &margins);
        let (nodes, ids, levels) = wide_tree_build::build(&mut items);
        Self { nodes, ids, levels, margins }
    }

    /// Which rays use boxes as stored, and the widening for all others.
    #[cfg(feature = "gpu")]
    pub(crate) fn near_rays(&self) -> NearRays {
        self.margins.near()
    }

    /// All nodes, as kernels read them.
    #[must_use]
    pub fn nodes(&self) -> &[WideNode] {
        &self.nodes
    }

    /// For each index in leaf order, the index of the sphere in input order; ascending within a leaf.
    #[must_use]
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// The number of nodes on the longest path from the root to the parent of a leaf, both included; at most
    /// `WIDE_LEVELS`.
    #[must_use]
    pub fn levels(&self) -> u32 {
        self.levels
    }
}
