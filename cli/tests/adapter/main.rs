//! Tests of the program on an adapter, run as a user runs it. Mesa's software driver lavapipe is enough.
//!
//! The tests fail if there is no adapter. With `PINHOLE_NO_GPU_TESTS=1`, every test here is ignored.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod faults;
#[path = "../../../tests/support/harness.rs"]
mod harness;
mod job;
mod plan;
mod render;
mod verify;
#[path = "../../../tests/support/view.rs"]
#[allow(dead_code, reason = "other tests use all of it")]
mod view;

use std::path::Path;
use std::process::{Command, Output};

use harness::{trial, trial_unless};
use libtest_mimic::Trial;
use pinhole::gpu::Headless;

/// A command that runs `pinhole` in a folder, with arguments that are separated by spaces.
fn command(folder: impl AsRef<Path>, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pinhole"));
    command.current_dir(folder).args(arguments.split(' '));
    command
}

/// The same command on the adapter of the tests, whose name may have spaces.
fn command_on(headless: &Headless, folder: impl AsRef<Path>, arguments: &str) -> Command {
    let mut command = command(folder, arguments);
    command.args(["--adapter", &headless.adapter_info().name]);
    command
}

#[track_caller]
fn succeed(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {stderr}");
    output
}

/// A trial that sends signals. It counts as ignored on systems other than Unix.
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
        let groups = [faults::trials(), job::trials(), plan::trials(), render::trials(), verify::trials()];
        groups.into_iter().flatten().collect()
    });
}
