//! Readers for pictures of this package, and for environment maps. They read from memory, and never open files.

pub mod environment;
pub mod picture;
