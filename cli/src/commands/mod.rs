//! The commands that have no folder of their own, with their code.

pub(crate) mod file_info;
pub(crate) mod generate;
pub(crate) mod info;
#[cfg(feature = "gpu")]
pub(crate) mod plan;
pub(crate) mod render;
pub(crate) mod view;
