//! Tests of the readers on files that are right, wrong and damaged.
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
#[path = "../support/damage.rs"]
mod damage;
#[path = "../../../../tests/support/effort.rs"]
#[expect(dead_code, reason = "other tests use the rest")]
mod effort;
#[path = "../support/seeds.rs"]
mod seeds;

mod binary;
mod files;
mod npy;
mod xyz;
