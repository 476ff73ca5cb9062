//! Lit pictures of scenes that are too large for memory. The paths of many samples are in flight at once, and for each of
//! their steps, one part of the scene after the other is read, searched and dropped.

mod loader;
mod picture;

pub use picture::PartsOptions;
