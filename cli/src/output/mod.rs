//! The outputs of the program: files, pictures with their data layers, and the lines about them.

pub(crate) mod annotations;
pub(crate) mod files;
pub(crate) mod picture;
pub(crate) mod report;
pub(crate) mod scene;
