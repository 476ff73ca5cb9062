//! Writers for pictures, their layers and spheres. They write to memory or to a sink, and never open files.

#[cfg(feature = "exr")]
pub mod exr;
#[cfg(feature = "formats")]
pub mod npy;
#[cfg(feature = "png")]
pub mod png;
pub mod raw;
