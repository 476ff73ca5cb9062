//! Vectors, rays, bases and boxes.

pub mod basis;
pub mod bounds;
pub mod math;
pub mod ray;
pub mod subject;
