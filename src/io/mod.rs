//! Formats: bytes in, spheres out; images in, bytes out. No file system.

#[cfg(feature = "xyz")]
mod elements;
#[cfg(feature = "npy")]
pub mod npy;
#[cfg(feature = "png")]
pub mod png;
#[cfg(feature = "xyz")]
pub mod xyz;
