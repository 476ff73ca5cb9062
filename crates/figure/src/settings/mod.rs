//! The layers from which settings are read, and the flags that reach them.

pub mod flags;
mod keys;
pub(crate) mod layers;
pub(crate) mod places;
mod words;

pub use keys::keys_of;
pub use layers::{Layer, Sources};
pub use words::{list_of, quoted, size_of};
