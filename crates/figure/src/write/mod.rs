//! Writers for pictures and their layers. They write to memory or to a sink, and never open files.

pub mod exr;
pub mod npy;
pub mod png;
