//! Vectors, rays, bases and boxes: what everything else is computed with.

pub mod basis;
pub mod bounds;
pub(crate) mod disk;
pub mod math;
pub mod ray;
