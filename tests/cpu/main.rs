//! Tests that need no adapter and start no program.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "tests; where floats are compared, the answer is exact"
)]

#[path = "../support/mod.rs"]
mod support;

mod added;
mod annotate;
#[path = "../support/arrays.rs"]
mod arrays;
#[path = "../support/binary_files/mod.rs"]
mod binary_files;
#[path = "../support/cases.rs"]
mod cases;
#[path = "../support/damage.rs"]
mod damage;
#[path = "../support/seeds.rs"]
mod seeds;

mod binary;
mod box_margin;
mod camera;
mod camera_path;
mod cameras;
mod color_by;
mod conformance;
mod environment;
mod files;
mod framing;
mod generate;
mod host_camera;
mod light;
mod npy;
mod pages;
mod parts;
mod pictures;
mod planted_faults;
mod reference;
mod run_file;
mod sampling;
mod scene;
mod scene_file;
mod scene_file_light;
mod search;
mod settings;
mod soundness;
mod structures;
mod verify;
mod written;
mod xyz;
