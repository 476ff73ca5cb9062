//! Flags that several commands share, what they mean, and their checks.

pub(crate) mod annotation;
pub(crate) mod camera;
pub(crate) mod common;
pub(crate) mod data;
pub(crate) mod light;
pub(crate) mod render;
