//! What the program writes: files, pictures with their data layers, and what it says about them.

pub(crate) mod files;
pub(crate) mod picture;
pub(crate) mod report;
