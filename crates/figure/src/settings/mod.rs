//! The layers from which settings are read, and the flags that reach them.

pub mod flags;
pub(crate) mod layers;
mod words;

pub use layers::{Layer, Sources};
