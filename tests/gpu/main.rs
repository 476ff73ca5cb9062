//! Tests that need an adapter. Mesa's lavapipe suffices.
//!
//! The tests fail if there is no adapter. If `PINHOLE_NO_GPU_TESTS=1`, this run has no GPU, and every test here counts
//! as ignored.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

#[path = "../support/any_rounding/mod.rs"]
mod any_rounding;
#[path = "../support/harness.rs"]
mod harness;
#[path = "../support/mod.rs"]
mod support;

mod adversary;
mod agreement;
mod appearance;
mod async_forms;
mod bricks;
mod compute;
mod denoised;
mod device;
mod device_shape;
mod embedding;
mod film_parts;
mod host;
mod lens;
mod light;
mod lit;
mod parts;
mod paths;
mod pictures;
mod plan;
mod planted;
mod profile;
mod ray_query;
mod replayed;
mod scenes;
mod self_test;
mod structures;
mod studio;
mod twin;
mod update;
mod verify;
mod verify_views;
mod written;

use harness::{headless, trial};

fn main() {
    harness::run(|| {
        let groups = [
            adversary::trials(),
            agreement::trials(),
            appearance::trials(),
            bricks::trials(),
            async_forms::trials(),
            lens::trials(),
            light::trials(),
            pictures::trials(),
            parts::trials(),
            paths::trials(),
            embedding::trials(),
            film_parts::trials(),
            host::trials(),
            denoised::trials(),
            device::trials(),
            device_shape::trials(),
            structures::trials(),
            studio::trials(),
            plan::trials(),
            vec![planted::trial()],
            profile::trials(),
            ray_query::trials(),
            self_test::trials(),
            twin::trials(),
            update::trials(),
            verify::trials(),
            written::trials(),
        ];
        groups.into_iter().flatten().collect()
    });
}
