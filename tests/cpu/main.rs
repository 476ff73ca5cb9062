//! Tests that need no adapter and start no program.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "tests; where floats are compared, the answer is exact"
)]

#[path = "../support/mod.rs"]
mod support;

mod box_margin;
mod camera;
mod cameras;
mod cone;
mod cone_light;
mod conformance;
mod conformance_cones;
mod framing;
mod generate;
mod host_camera;
mod light;
mod pages;
mod parts;
mod planted_faults;
mod reference;
mod run_file;
mod sampling;
mod scene;
mod search;
mod settings;
mod smooth;
mod soundness;
mod structures;
mod verify;
mod written;
