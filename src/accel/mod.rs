//! Acceleration structures: built from spheres in the scene's frame, stored as plain data, and traversed on the CPU.
//!
//! Every structure refers to the same spheres, and every traversal calls the same sphere test in f32, so that the
//! result, distance and id, is that of testing every sphere, to the bit. The kernels in `shaders/` walk the same data
//! in the same order. One walk of the 8-wide tree is in f64 and calls the tests of the CPU reference (`wide_tree_visit`).

pub(crate) mod ball;
mod brick;
#[cfg(feature = "gpu")]
mod brick_bounds;
mod bricks;
mod cell_octet;
mod cell_vectors;
mod cells;
mod divide;
mod divide_by_sample;
mod extent;
pub(crate) mod grid;
pub(crate) mod grid_build;
pub(crate) mod grid_check;
mod grid_dense;
mod grid_empty;
mod grid_geometry;
mod grid_lists;
mod grid_slabs;
mod grid_sort;
pub(crate) mod grid_visit;
mod grid_walk;
mod leaf;
pub(crate) mod list;
mod outliers;
mod plan;
mod primitive;
pub(crate) mod query;
mod query_boxes;
pub(crate) mod slab;
pub(crate) mod sphere;
mod split;
mod statistics;
pub(crate) mod tree_check;
#[cfg(test)]
mod tree_tests;
mod wide_group;
pub(crate) mod wide_node;
pub(crate) mod wide_tree;
mod wide_tree_build;
mod wide_tree_trace;
pub(crate) mod wide_tree_visit;

pub use brick::{Accel, Brick, Index, Structure};
#[cfg(feature = "gpu")]
pub(crate) use brick_bounds::BrickBounds;
pub use bricks::Bricks;
pub use outliers::Crowd;
#[cfg(feature = "gpu")]
pub(crate) use plan::LIST_LEN;
pub use plan::{AccelChoice, AccelPlan, PlannedBuffer};
pub use primitive::{BrickKind, Primitive};
pub use query_boxes::QueryBoxes;
pub use statistics::SceneStatistics;
#[cfg(feature = "gpu")]
pub(crate) use statistics::margin_of;

/// Constants that kernels share, for the test that compares both.
#[cfg(all(test, feature = "gpu"))]
pub(crate) mod shared {
    pub(crate) use super::grid::{LAST, word};
    pub(crate) use super::wide_group::PACKED_ROOT;
    pub(crate) use super::wide_node::{LEAF_COUNT_SHIFT, LEAF_FIRST};
}
