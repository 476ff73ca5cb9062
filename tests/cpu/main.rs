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
mod appearance;
#[path = "../support/arrays.rs"]
mod arrays;
#[path = "../support/binary_files/mod.rs"]
mod binary_files;
#[path = "../support/cases.rs"]
mod cases;
#[path = "../support/damage.rs"]
mod damage;
#[path = "../support/seeds/mod.rs"]
mod seeds;

mod basis;
mod binary;
mod box_margin;
mod camera;
mod camera_path;
mod camera_tables;
mod color_by;
mod comparator;
mod conformance;
mod denoised;
mod environment;
mod environment_files;
mod film_parts;
mod framing;
mod fuzz;
mod generate;
mod host_camera;
mod hostile_rays;
mod least_errors;
mod legal_camera;
mod legal_camera_rays;
mod legal_device;
mod lens;
mod light;
mod nearest;
mod npy;
mod outliers;
mod outline;
mod pages;
mod perspective;
mod pictures;
mod reference;
mod refused;
mod round_cameras;
mod run_file;
mod run_file_light;
mod sampling;
mod scene;
mod scene_file;
mod scene_file_light;
mod scene_file_write;
mod search;
mod select;
mod settings;
mod soundness;
mod steps;
mod stereo;
mod structures;
mod trajectory;
mod update;
mod verify;
mod written;
mod xyz;
