//! The program on an adapter, run as a user runs it; Mesa's lavapipe is enough.
//!
//! No adapter is a failure. If `PINHOLE_NO_GPU_TESTS=1`, every test here counts as ignored.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

#[path = "../../../tests/support/harness.rs"]
mod harness;
mod light;
mod plan;
mod render;
mod verify;
#[path = "../../../tests/support/view.rs"]
#[allow(dead_code, reason = "other tests use all of it")]
mod view;

use harness::trial;

fn main() {
    harness::run(|| {
        let groups = [light::trials(), plan::trials(), render::trials(), verify::trials()];
        groups.into_iter().flatten().collect()
    });
}
