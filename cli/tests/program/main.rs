//! The program, run as a user runs it, in an empty folder.
//!
//! Everything here renders on the CPU, or on a machine that is made to look as if it had no driver, so
//! no adapter is needed.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "../../../tests/support/arrays.rs"]
mod npy_files;

mod arrays;
mod bad_input;
mod generate;
mod good_input;
mod interrupt;
mod light;
mod pictures;
#[cfg(feature = "gpu")]
mod shaders;
mod stereo;
mod support;
mod verify;
