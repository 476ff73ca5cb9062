//! Acceleration structures, built from the spheres in the scene's frame and stored as plain data.
//!
//! The kernels in `shaders/` walk this data in f32. On devices that compute their sphere test alike in all
//! kernels, every structure gives the answer of testing all spheres: its distance and id, to the bit. On the CPU, `grid_visit` and `wide_tree_visit` walk it in f64,
//! and the caller supplies the sphere test.

pub(crate) mod ball;
mod bricks;
mod cells;
#[cfg(test)]
mod check_tests;
mod cone_cells;
mod cone_grid;
mod divide;
pub(crate) mod grid;
mod grid_build;
mod grid_dense;
mod grid_sort;
pub(crate) mod grid_visit;
mod listed;
mod plan;
pub(crate) mod slab;
mod split;
mod statistics;
mod structure;
#[cfg(feature = "gpu")]
pub(crate) mod tile_lists;
#[cfg(feature = "gpu")]
pub(crate) mod tiles;
pub(crate) mod wide_tree;
mod wide_tree_build;
pub(crate) mod wide_tree_visit;

#[cfg(feature = "gpu")]
pub(crate) use bricks::BrickBounds;
pub use bricks::{Accel, Brick, Bricks, Index};
#[cfg(all(feature = "gpu", test))]
pub(crate) use cone_cells::CAPSULES_PER_VECTOR;
#[cfg(feature = "gpu")]
pub(crate) use plan::LIST_LEN;
pub use plan::{AccelPlan, ConesPlan, PlannedBuffer};
#[cfg(feature = "gpu")]
pub(crate) use statistics::margin_of;
pub use statistics::{Crowd, SceneStatistics};
pub use structure::{AccelChoice, BrickKind, Primitive, Structure};
