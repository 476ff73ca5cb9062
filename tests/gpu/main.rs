//! Tests that need an adapter. Mesa's lavapipe suffices.
//!
//! The tests fail if there is no adapter. If `PINHOLE_NO_GPU_TESTS=1`, this run has no GPU, and every test here counts
//! as ignored.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

#[path = "../support/any_rounding/mod.rs"]
mod any_rounding;
#[path = "../support/harness.rs"]
mod harness;
#[path = "../support/host_program.rs"]
mod host_program;
#[path = "../support/mod.rs"]
mod support;

mod adversary;
mod bricks;
mod cones;
mod device;
mod embedding;
mod host;
mod light;
mod lit;
mod lit_scenes;
mod parts;
mod pictures;
mod planted;
mod ray_query;
mod scenes;
mod structures;
mod twin;
mod update;
mod verify;
mod written;

use harness::{headless, trial};

fn main() {
    harness::run(|| {
        let groups = [
            adversary::trials(),
            bricks::trials(),
            cones::trials(),
            light::trials(),
            pictures::trials(),
            parts::trials(),
            lit::trials(),
            embedding::trials(),
            host::trials(),
            device::trials(),
            structures::trials(),
            planted::checks(),
            ray_query::trials(),
            twin::trials(),
            update::trials(),
            verify::trials(),
            written::trials(),
        ];
        // Groups take turns: tests that follow each other need the same kernels, and a device compiles one at a time.
        let mut trials: Vec<_> = groups.into_iter().flat_map(|group| group.into_iter().enumerate()).collect();
        trials.sort_by_key(|(index, _)| *index);
        trials.into_iter().map(|(_, trial)| trial).collect()
    });
}
