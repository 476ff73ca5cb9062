//! NumPy arrays: layers and spheres out, spheres in.

mod header;
mod layers;
mod spheres;

pub use layers::{NpyError, encode};
pub use spheres::{SpheresError, read_spheres, write_spheres};
