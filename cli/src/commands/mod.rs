//! The commands that have no room of their own, each with what it does.

pub(crate) mod file_info;
pub(crate) mod generate;
pub(crate) mod info;
#[cfg(feature = "gpu")]
pub(crate) mod plan;
pub(crate) mod render;
pub(crate) mod view;
