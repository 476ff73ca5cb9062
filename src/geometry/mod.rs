//! Vectors, rays, bases and boxes.

pub mod basis;
pub mod bounds;
pub(crate) mod cone;
pub(crate) mod cone_crossing;
pub mod math;
pub mod ray;
pub mod subject;
