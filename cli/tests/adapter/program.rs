//! Runs the program `pinhole`.

use std::path::Path;
use std::process::{Command, Output};

use pinhole::gpu::Headless;

/// A command that runs `pinhole` in a folder, with arguments that are separated by spaces.
pub(crate) fn command(folder: impl AsRef<Path>, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pinhole"));
    command.current_dir(folder).args(arguments.split(' '));
    command
}

/// The same command on the adapter of the tests, whose name may have spaces.
pub(crate) fn command_on(
    headless: &Headless,
    folder: impl AsRef<Path>,
    arguments: &str,
) -> Command {
    let mut command = command(folder, arguments);
    command.args(["--adapter", &headless.adapter_info().name]);
    command
}

#[track_caller]
pub(crate) fn succeed(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {stderr}");
    output
}
