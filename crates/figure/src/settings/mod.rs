//! The layers from which settings are read, and the flags that reach them.

pub(crate) mod layers;

pub use layers::{Layer, Sources};
