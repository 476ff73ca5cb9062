//! Acceleration structures: built from spheres in the scene's frame, and stored as plain data.
//!
//! The kernels in `shaders/` walk this data in f32, with a sphere test that gives every structure the answer of testing
//! all spheres, distance and id, to the bit. On the CPU, `grid_visit` and `wide_tree_visit` walk it in f64 for callers
//! that bring their own test.

pub(crate) mod ball;
mod brick;
#[cfg(feature = "gpu")]
mod brick_bounds;
mod bricks;
mod cells;
#[cfg(test)]
mod check_tests;
mod divide;
mod divide_by_sample;
mod extent;
pub(crate) mod grid;
mod grid_build;
mod grid_dense;
mod grid_empty;
mod grid_lists;
mod grid_slabs;
mod grid_sort;
pub(crate) mod grid_visit;
mod outliers;
mod plan;
pub(crate) mod slab;
mod split;
mod statistics;
mod structure;
pub(crate) mod wide_node;
pub(crate) mod wide_tree;
mod wide_tree_build;
pub(crate) mod wide_tree_visit;

pub use brick::{Accel, Brick, Index, QueryBoxes};
#[cfg(feature = "gpu")]
pub(crate) use brick_bounds::BrickBounds;
pub use bricks::Bricks;
pub use outliers::Crowd;
#[cfg(feature = "gpu")]
pub(crate) use plan::LIST_LEN;
pub use plan::{AccelPlan, PlannedBuffer};
pub use statistics::SceneStatistics;
#[cfg(feature = "gpu")]
pub(crate) use statistics::margin_of;
pub use structure::{AccelChoice, BrickKind, Primitive, Structure};

/// Constants that kernels share, for the test that compares both.
#[cfg(all(test, feature = "gpu"))]
pub(crate) mod shared {
    pub(crate) use super::grid::{LAST, word};
    pub(crate) use super::wide_node::{LEAF_COUNT_SHIFT, LEAF_FIRST};
}
