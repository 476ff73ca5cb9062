//! Acceleration structures: spheres in the scene's frame in, plain data out, and the traversal of that
//! data on the CPU.
//!
//! Every structure is an index into the same spheres, and every traversal calls the same sphere test in
//! f32, so that the answer, distance and id, is that of trying every sphere, to the bit. The kernels in
//! `shaders/` walk the same data in the same order.

mod brick;
mod cells;
mod divide;
mod grid;
mod grid_build;
mod grid_crowd;
mod grid_empty;
mod grid_walk;
pub mod list;
mod parallel;
mod plan;
mod query;
mod sphere;
mod statistics;

pub use brick::{Accel, Brick, Index, Structure};
pub use grid::{Grid, GridStatistics, ListLayout};
pub use grid_build::{BuiltGrid, GridBudget, build_grid};

pub use plan::{AccelChoice, AccelPlan, PlannedBuffer};
pub use query::{NO_HIT, Nearest, RayF32};
pub use sphere::intersect_sphere;
pub use statistics::SceneStatistics;
