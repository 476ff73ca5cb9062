//! Acceleration structures: built from spheres in the scene's frame, stored as plain data, and traversed on the CPU.
//!
//! Every structure refers to the same spheres, and every traversal calls the same sphere test in f32, so that the
//! result, distance and id, is that of testing every sphere, to the bit. The kernels in `shaders/` walk the same data
//! in the same order.

mod binary_tree;
mod binary_tree_trace;
mod brick;
mod cells;
mod divide;
mod extent;
mod grid;
mod grid_build;
mod grid_check;
mod grid_dense;
mod grid_empty;
mod grid_geometry;
mod grid_sort;
mod grid_walk;
mod leaf;
pub mod list;
mod plan;
mod primitive;
mod query;
mod slab;
mod sphere;
mod split;
mod statistics;
mod tree_check;
#[cfg(test)]
mod tree_tests;
mod wide_group;
mod wide_node;
mod wide_tree;
mod wide_tree_build;
mod wide_tree_trace;

pub use binary_tree::{
    BINARY_INNER, BINARY_LEAF, BINARY_LEVELS, BinaryChild, BinaryNode, BinaryTree,
};
pub use brick::{Accel, Brick, Index, Structure};
pub use grid::{Grid, GridStatistics, ListLayout};
pub use grid_build::{BuiltGrid, GridBudget, build_grid};
pub use grid_check::GridError;
#[cfg(feature = "gpu")]
pub(crate) use plan::LIST_LEN;
pub use plan::{AccelChoice, AccelPlan, PlannedBuffer};
pub use primitive::{BrickKind, Primitive};
pub use query::{NO_HIT, Nearest, RayF32};
pub use slab::SMALLEST_COMPONENT;
pub use sphere::intersect_sphere;
pub use statistics::SceneStatistics;
pub use tree_check::{TreeError, TreeStatistics};
pub use wide_node::{WIDE_LEAF, WideNode};
pub use wide_tree::{WIDE_LEVELS, WideTree};

/// Constants that kernels share, for the test that compares both.
#[cfg(all(test, feature = "gpu"))]
pub(crate) mod shared {
    pub(crate) use super::binary_tree_trace::NO_ENTRY;
    pub(crate) use super::grid::{LAST, word};
    pub(crate) use super::wide_group::PACKED_ROOT;
    pub(crate) use super::wide_node::{LEAF_COUNT_SHIFT, LEAF_FIRST};
}
