//! The code that the viewer shares with `pinhole render`, so that both make the same picture.
//!
//! The state of a view is [`RenderFlags`]: a file, and flags of `pinhole render`. [`OpenView`] has the spheres, the
//! camera and the settings that follow from them. [`StillRenderer`] renders the picture for a window, and
//! [`RenderFlags::save`] runs `pinhole render` itself.

use std::fmt;
use std::process::ExitCode;

pub use flags::RenderFlags;
pub use open_view::{Facts, OpenView, TimeLine};
pub use still::{StillPicture, StillRenderer};

use crate::terminal::failure::{FAILED, Failure, USAGE};
pub use crate::viewing::camera::ViewCamera;

mod camera;
mod flags;
mod open_view;
mod still;

/// The reason why something cannot be shown: one line for the user, and the exit code of `pinhole`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewError {
    message: String,
    code: u8,
}

impl ViewError {
    /// A failure, with the exit code 1.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: FAILED }
    }

    /// Wrong usage; the exit code is 2.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: USAGE }
    }

    /// The exit code that `pinhole` has in this case.
    pub fn exit_code(&self) -> ExitCode {
        self.code.into()
    }
}

impl From<Failure> for ViewError {
    fn from(failure: Failure) -> Self {
        let code = if matches!(failure, Failure::Usage(_)) { USAGE } else { FAILED };
        Self { message: failure.message(), code }
    }
}

impl fmt::Display for ViewError {
    /// Writes the message on one line, without the word `error`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&pinhole::internals::text::whole_line(&self.message))
    }
}

impl std::error::Error for ViewError {}

/// Prepares the process for showing files. It starts threads, and turns progress on the terminal off.
pub fn prepare() -> Result<(), ViewError> {
    crate::terminal::progress::close();
    Ok(crate::terminal::threads::start()?)
}

/// Prints an error as `pinhole` does, on standard error.
pub fn print_error(error: &dyn fmt::Display) {
    crate::terminal::progress::tell(format_args!("error: {error}"));
}

/// Prints a line on standard error, with control characters escaped.
pub fn print_note(line: &str) {
    crate::terminal::progress::tell(line);
}

/// Writes a number with a comma before each group of three digits.
pub fn grouped(number: usize) -> String {
    crate::output::report::grouped(number)
}

/// Prints a line on standard output.
pub fn print_line(line: &str) {
    // A closed pipe is not an error here.
    let _ = crate::terminal::progress::answer(format!("{line}\n").as_bytes());
}
