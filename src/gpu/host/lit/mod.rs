//! Lit pictures in the encoders of a host: what is recorded, how much of it at a time, and what was executed.

mod cursor;
pub(in crate::gpu) mod picture;
pub(in crate::gpu) mod progress;
pub(in crate::gpu) mod renderer;
pub(in crate::gpu) mod resolve;
pub(in crate::gpu::host) mod tickets;
