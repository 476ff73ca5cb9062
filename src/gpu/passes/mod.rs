//! Passes over pixels and paths. Each is built once for a device and records into an encoder. None submits or waits.

pub(crate) mod bands;
pub(crate) mod emitter_table;
pub(crate) mod frame;
pub(crate) mod lit;
pub(crate) mod record;
pub(crate) mod renderer;
pub(crate) mod renderer_options;
pub(crate) mod targets;
pub(crate) mod tiles;
pub(crate) mod visible_bricks;
