//! Writers: an image, its layers or spheres in, bytes out. They touch no files.

#[cfg(feature = "exr")]
pub mod exr;
#[cfg(feature = "npy")]
pub mod npy;
#[cfg(feature = "png")]
pub mod png;
pub mod raw;
