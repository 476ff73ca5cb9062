//! Acceleration structures: spheres in the scene's frame in, plain data out, and the traversal of that
//! data on the CPU.
//!
//! Every structure is an index into the same spheres, and every traversal calls the same sphere test in
//! f32, so that the answer, distance and id, is that of trying every sphere, to the bit. The kernels in
//! `shaders/` walk the same data in the same order.

mod query;
mod sphere;

pub use query::{NO_HIT, Nearest, RayF32};
pub use sphere::intersect_sphere;
