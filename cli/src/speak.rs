//! Words for the user. That nobody listens is no reason to fail.

use std::fmt;
use std::io::{self, Write};

use super::progress;
use pinhole::text::one_line;

/// One line on standard error, with nothing in it that a terminal would obey.
pub(super) fn tell(line: impl fmt::Display) {
    let line = one_line(&line.to_string());
    progress::beside(|| {
        let _ = writeln!(io::stderr().lock(), "{line}");
    });
}

/// Text of several lines on standard error.
pub(super) fn tell_all(text: &str) {
    let _ = write!(io::stderr().lock(), "{text}");
}

/// Text on standard output, which was asked for.
pub(super) fn answer(bytes: &[u8]) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        // The reader has seen enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}
