//! `pinhole view`: starts the viewer, which is a separate program because windows need many dependencies.

use std::path::PathBuf;
use std::process::Command;

use anyhow::Context;
use clap::Args;

use crate::flags::common::{AccelArgs, DeviceArgs, InputArgs};
use crate::flags::settings::{PICTURE, SettingArgs};
use crate::terminal::failure::Failure;

/// The flags of `render` that say what is seen. The viewer reads them itself; here they are parsed for the help and
/// for errors.
#[derive(Debug, Args)]
#[command(
    after_help = "The flags are those of `render`, and say what the window shows at first. The window is the program \
    `pinhole-viewer`, beside `pinhole` or on the PATH; `cargo install --path viewer` installs it."
)]
pub(crate) struct ViewArguments {
    #[command(flatten)]
    pub(crate) input: InputArgs,
    #[command(flatten)]
    look: SettingArgs<PICTURE>,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    accel: AccelArgs,
}

/// Starts the viewer with the arguments of this process.
pub(crate) fn run(_: &ViewArguments) -> Result<(), Failure> {
    let Some(viewer) = viewer() else {
        return Err(Failure::Job(anyhow::anyhow!(
            "the viewer, pinhole-viewer, is neither beside pinhole nor on the PATH; install it from the sources of \
             pinhole: cargo install --path viewer"
        )));
    };
    let mut command = Command::new(&viewer);
    command.args(std::env::args_os().skip(2));
    let error = started(&mut command);
    Err(error).with_context(|| format!("{}: cannot be started", viewer.display())).map_err(Into::into)
}

/// Replaces this process by the viewer; returns only if that fails.
#[cfg(unix)]
fn started(command: &mut Command) -> std::io::Error {
    std::os::unix::process::CommandExt::exec(command)
}

/// Runs the viewer and ends with its exit code; returns only if it cannot be started.
#[cfg(not(unix))]
fn started(command: &mut Command) -> std::io::Error {
    match command.status() {
        Ok(status) => std::process::exit(status.code().unwrap_or(crate::terminal::failure::FAILED.into())),
        Err(error) => error,
    }
}

/// Finds the viewer: beside this program, or in the folders of `PATH`.
fn viewer() -> Option<PathBuf> {
    let name = format!("pinhole-viewer{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().ok().map(|program| program.with_file_name(&name));
    let on_path = std::env::var_os("PATH").unwrap_or_default();
    let on_path = std::env::split_paths(&on_path).map(|folder| folder.join(&name));
    beside.into_iter().chain(on_path).find(|path| path.is_file())
}
