//! Tests of the program on an adapter, run as a user runs it. Mesa's software driver lavapipe is enough.
//!
//! The tests fail if there is no adapter. With `PINHOLE_NO_GPU_TESTS=1`, every test here is ignored.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod bricks;
mod faults;
#[path = "../../../tests/support/harness.rs"]
mod harness;
mod job;
mod light;
mod plan;
mod program;
mod render;
mod verify;
#[path = "../../../tests/support/view.rs"]
#[allow(dead_code, reason = "other tests use all of it")]
mod view;

use harness::{trial, trial_unless};
use libtest_mimic::Trial;
use pinhole::gpu::Headless;

/// A trial that sends signals; elsewhere than on Unix it counts as ignored.
fn trial_of_signals(name: &str, test: fn(&'static Headless)) -> Trial {
    let lacking = |_: &_| (!cfg!(unix)).then(|| "this system has no signals".to_owned());
    trial_unless(name, lacking, move |headless| {
        test(headless);
        Ok(())
    })
}

fn main() {
    if faults::is_child() {
        return;
    }
    harness::run(|| {
        let groups = [
            bricks::trials(),
            faults::trials(),
            job::trials(),
            light::trials(),
            plan::trials(),
            render::trials(),
            verify::trials(),
        ];
        groups.into_iter().flatten().collect()
    });
}
