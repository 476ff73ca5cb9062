//! Shaders. The source of a kernel is the concatenation of a list of parts.
//!
//! WGSL has no modules, and the order of its declarations does not matter, so a list of parts serves as a module
//! system. The lists are in `shaders/kernels.txt`. The comment at the start of each part lists what it provides and
//! needs. A test compares the lists with the source, and writes the tables of `shaders/README.md`.

#[cfg(not(target_arch = "wasm32"))]
pub(super) mod fold;
pub(super) mod formats;
mod kernel;
pub(super) mod layouts;
mod part;
mod pipeline;
mod primary;
pub(super) mod records;
mod row_order;
pub(super) mod textures;

pub(super) use kernel::{Constant, Kernel};
pub(super) use part::Part;
#[cfg(test)]
pub(super) use part::{VARIANT, variants};
pub(super) use pipeline::{pipeline, pipeline_with, with_constants};
pub(super) use primary::{
    BrickPass, camera_constant, color_target_choice, data_layers_choice, lit_choices, probe_kernel, shade_kernel,
    trace_kernel,
};
