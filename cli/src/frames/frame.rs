//! One frame of a file.

use crate::failure::Failure;
use crate::input::Source;
use crate::input::contents::Contents;

/// Reads one frame.
pub(super) fn frame(source: &mut Source, number: usize) -> Result<Contents, Failure> {
    source.set_frame(number);
    source.contents().map_err(|failure| match failure {
        Failure::Job(error) => Failure::Job(error.context(format!("frame {number}"))),
        other => other,
    })
}
