//! Passes over pixels and paths. Each is built once for a device and records into an encoder. None submits or waits.

pub(in crate::gpu) mod bands;
pub(in crate::gpu) mod emitter_table;
pub(in crate::gpu) mod frame;
pub(in crate::gpu) mod lit;
pub(in crate::gpu) mod order;
pub(in crate::gpu) mod record;
pub(in crate::gpu) mod renderer;
pub(in crate::gpu) mod renderer_options;
pub(in crate::gpu) mod targets;
pub(in crate::gpu) mod tiles;
pub(in crate::gpu) mod visible_bricks;
pub(in crate::gpu) mod visible_region;
