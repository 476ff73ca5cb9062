//! Scene files, colours from data, annotations, and pictures as files.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "tests; where floats are compared, the answer is exact"
)]

#[path = "../../../../tests/support/cases.rs"]
mod cases;
#[path = "../../../../tests/support/mod.rs"]
mod support;

mod added;
mod annotate;
mod camera_path;
mod color_by;
mod cones;
mod environment;
mod lines;
mod pictures;
mod scene_file;
mod scene_file_light;
mod settings;
mod settings_page;
mod show;
