//! Prints messages for the user. A message that cannot be printed is not an error.

use std::fmt;
use std::io::{self, Write};

use super::progress_line::while_hidden;
use pinhole::internals::text::one_line;

/// Prints one line on standard error, with control characters escaped.
pub(super) fn tell(line: impl fmt::Display) {
    let line = one_line(&line.to_string());
    while_hidden(|| {
        let _ = writeln!(io::stderr().lock(), "{line}");
    });
}

/// Prints a text of several lines on standard error.
pub(super) fn tell_all(text: &str) {
    let _ = write!(io::stderr().lock(), "{text}");
}

/// Prints the result on standard output.
pub(super) fn answer(bytes: &[u8]) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        // The reader has closed the pipe because it needs no more.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}
