//! The program `pinhole`. It parses the arguments, checks them, turns them into types of the library, and runs the
//! job. Only this crate uses clap, prints, and accesses the file system.
//!
//! It is a library for the viewer, which turns flags into pictures by the same code: see [`viewing`].

#![allow(rustdoc::broken_intra_doc_links, reason = "the comments of arguments are their help texts, not Markdown")]

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use command_line::{Arguments, Command};

use crate::terminal::explain::explain;
use crate::terminal::failure::Failure;
use crate::terminal::habits::plain_words;
use crate::terminal::progress::tell;
use pinhole::internals::text::whole_line;

#[cfg(feature = "gpu")]
mod bench;
mod bricks;
mod command_line;
mod commands;
mod flags;
mod frames;
mod input;
mod jobs;
mod output;
mod proof;
mod render;
mod terminal;
#[cfg(feature = "gpu")]
#[allow(clippy::missing_errors_doc, clippy::must_use_candidate, reason = "for the viewer alone")]
pub mod viewing;

/// Runs the program with the arguments of the process. This must be the first action of the process.
///
/// Exit codes: 0 done, 1 the job failed, 2 wrong usage, 3 a check failed, 4 a check
/// could not decide, 5 the device was lost or did not answer, 130 stopped.
#[must_use]
pub fn main() -> ExitCode {
    #[cfg(target_os = "linux")]
    quieten_device_select();
    #[cfg(feature = "gpu")]
    quieten_lost_devices();
    run()
}

/// Silences the panic with which wgpu reports a lost device. The library catches it, and the program prints one line.
#[cfg(feature = "gpu")]
fn quieten_lost_devices() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !pinhole::gpu::catches_panics() {
            usual(panic);
        }
    }));
}

/// Switches off Mesa's device-select layer where it would only print errors.
///
/// Without a desktop session, the layer fails to reach a Wayland display, and libwayland then prints a line that starts
/// with `error:` for every Vulkan instance. The layer puts one GPU first, which the program does by itself. The layer
/// stays on for a user who has configured it.
#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "the layer reads nothing but the environment")]
fn quieten_device_select() {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if !is_set("XDG_RUNTIME_DIR") && !is_set("MESA_VK_DEVICE_SELECT") {
        // SAFETY: this is the first thing that `main` does, so there is no other thread yet.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}

fn run() -> ExitCode {
    let words = match plain_words(std::env::args_os().collect()) {
        Ok(words) => words,
        Err(failure) => {
            tell(&failure);
            return failure.exit_code();
        }
    };
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(error) => {
            let words: Vec<_> = words.iter().skip(1).map(|word| word.to_string_lossy().into()).collect();
            return explain(&error, &words);
        }
    };
    terminal::keep_words(words);
    let result = terminal::interrupt::install().and_then(|()| execute(arguments.command));
    terminal::progress::clear();
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(&failure);
            failure.exit_code()
        }
    }
}

fn execute(command: Command) -> Result<(), Failure> {
    match command {
        Command::Render(args) => commands::render::run_named(*args),
        Command::Verify(args) => proof::verify::run(&args),
        Command::Certify(args) => proof::certify::run(&args),
        #[cfg(feature = "gpu")]
        Command::Plan(args) => commands::plan::run(&args),
        #[cfg(feature = "gpu")]
        Command::Bench(args) => bench::run(&args),
        Command::Job(args) => jobs::run(&args),
        Command::Sort(args) => bricks::run(&args),
        Command::Demo(args) => commands::generate::run_demo(&args),
        Command::Generate(args) => commands::generate::run(&args),
        Command::Info(args) => commands::info::run(&args),
        Command::View(args) => commands::view::run(&args),
    }
}

/// Runs a command of the program in this process, for `fuzz`, and returns the message of its failure.
///
/// # Errors
/// Returns the line that the program would show, or several lines if the words are not those of a command.
#[doc(hidden)]
pub fn run_command(words: Vec<OsString>) -> Result<(), String> {
    let words = plain_words(words).map_err(|failure| failure.message())?;
    let arguments = Arguments::try_parse_from(&words).map_err(|error| error.to_string())?;
    terminal::keep_words(words);
    execute(arguments.command).map_err(|failure| whole_line(&failure.message()))
}
