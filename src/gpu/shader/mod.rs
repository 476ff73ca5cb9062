//! Shaders: kernels are lists of parts, put one behind the other.
//!
//! WGSL has no modules and does not care about the order of declarations, so a list of parts is a module system. Each
//! part starts with what it provides and what it needs; a test compares both with its text and writes the tables of
//! `shaders/README.md`.

pub(super) mod formats;
mod kernel;
pub(super) mod layouts;
mod part;
mod pipeline;
mod primary;
pub(super) mod records;

pub(super) use kernel::Kernel;
pub(super) use part::{Part, part};
#[cfg(test)]
pub(super) use part::{VARIANT, variants};
pub(super) use pipeline::pipeline;
pub(super) use primary::{
    BrickPass, Probe, camera_parts, occluded_kernel, self_test_kernel, shade_kernel,
    structure_parts, trace_kernel,
};
