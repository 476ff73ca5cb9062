//! Tests of the program, run as a user runs it, in an empty folder.
//!
//! No adapter is needed: the tests render on the CPU reference, or hide the drivers of the machine.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "../../../tests/support/cases.rs"]
mod cases;
#[path = "../../../tests/support/arrays.rs"]
mod npy_files;

mod bricks;
mod certified;
mod certify;
mod cones;
mod data;
mod frames;
mod habits;
mod input;
mod interrupt;
#[cfg(unix)]
mod job_faults;
mod jobs;
mod kinds;
mod pictures;
mod snapshots;
mod support;
mod verify;
