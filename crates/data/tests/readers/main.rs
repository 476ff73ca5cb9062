//! Tests of the readers on files that are right and wrong. `fuzz` damages others.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "tests; where floats are compared, the answer is exact"
)]

#[path = "../../../../tests/support/arrays.rs"]
mod arrays;
#[path = "../support/binary_files/mod.rs"]
mod binary_files;
#[path = "../../../../tests/support/cases.rs"]
mod cases;

mod binary;
mod cones;
mod file_set;
mod files;
mod npy;
mod together;
mod xyz;
