//! Flags that several commands share, their meaning, and their checks.

pub(crate) mod camera;
pub(crate) mod common;
pub(crate) mod render;
pub(crate) mod settings;
