//! Formats: bytes in, spheres or an environment out; images and spheres in, bytes out. No file system.

#[cfg(feature = "xyz")]
mod elements;
#[cfg(any(feature = "exr", feature = "hdr"))]
pub mod environment;
#[cfg(feature = "exr")]
pub mod exr;
#[cfg(feature = "npy")]
pub mod npy;
#[cfg(feature = "npy")]
pub mod npz;
mod numbers;
#[cfg(feature = "png")]
pub mod png;
pub mod raw;
#[cfg(feature = "xyz")]
pub mod xyz;
