//! Tests of the program, run as a user runs it, in an empty folder.
//!
//! No adapter is needed: the tests render on the CPU reference, or hide the drivers of the machine.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "../../../tests/support/cases.rs"]
mod cases;
#[path = "../../../tests/support/arrays.rs"]
mod npy_files;

mod arrays;
mod bad_input;
mod bricks;
mod camera_path;
mod certified;
mod certify;
mod colors;
mod file_info;
mod frames;
mod generate;
mod good_input;
mod interrupt;
mod job;
mod job_depth;
#[cfg(unix)]
mod job_faults;
mod job_input;
#[cfg(unix)]
mod job_slurm;
mod legend_room;
mod light;
mod looks;
mod movie_colors;
mod pictures;
#[cfg(feature = "gpu")]
mod profile;
#[cfg(feature = "gpu")]
mod shaders;
mod snapshots;
mod stereo;
mod stop_rules;
mod structure;
mod support;
mod verify;
