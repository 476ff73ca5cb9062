//! Live pictures, which look finished while they move: a few rays for each pixel and frame, averaged over frames and
//! neighbours.

pub(in crate::gpu) mod picture;
mod view;
