//! Every kind of file that pinhole reads from strangers, with good files of it and with all that the program does to read
//! one. Reading any bytes must end soon, with data or with an error of one line, and take little memory.
//!
//! `tests/damaged.rs` damages the good files at random. `src/main.rs` hands the bytes of LLVM's fuzzer to a target.
#![allow(clippy::unwrap_used, clippy::panic, clippy::missing_panics_doc, clippy::missing_errors_doc, reason = "a test")]

use std::fmt::Display;
use std::path::Path;

use pinhole::internals::text::is_control;
use pinhole_data::load::FORMATS;
use tempfile::TempDir;

#[path = "../../crates/data/tests/support/binary_files/mod.rs"]
#[allow(dead_code, reason = "the tests of the readers use all of it")]
mod binary_files;
pub mod damage;
mod figures;
mod formats;
mod program;
mod seals;
mod seeds;

type Read = Box<dyn Fn(&[u8]) -> Result<(), String> + Send + Sync>;

/// A kind of file.
pub struct Target {
    /// Good files.
    pub seeds: Vec<Vec<u8>>,
    /// The number of damaged files that the tests read in a whole campaign.
    pub tries: u32,
    read: Read,
    /// Holds the files that reading needs.
    _folder: TempDir,
}

/// The name of a kind, and what makes its target.
type Named = (&'static str, fn(TempDir) -> Target);

/// The kinds of files beside the formats of spheres.
const OTHERS: [Named; 11] = [
    ("cones", formats::cones),
    ("scene", figures::scene),
    ("camera-path", figures::camera_path),
    ("selection", figures::selection),
    ("sky", figures::sky),
    ("picture", program::picture),
    ("certificate", program::certificate),
    ("answers", program::answers),
    ("run", program::run_file),
    ("bricks", program::bricks),
    ("job", program::job),
];

/// The names of all targets, those of the formats first.
pub fn names() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().map(|format| format.name).chain(OTHERS.iter().map(|other| other.0))
}

impl Target {
    fn new(
        folder: TempDir,
        seeds: Vec<Vec<u8>>,
        read: impl Fn(&[u8]) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        Self { seeds, tries: 40_000, read: Box::new(read), _folder: folder }
    }

    /// Makes the target of this name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        // A folder in memory is faster.
        let shared = Path::new("/dev/shm");
        let near = if shared.is_dir() { shared.to_owned() } else { std::env::temp_dir() };
        let folder = tempfile::tempdir_in(near).unwrap();
        if let Some(format) = FORMATS.iter().find(|format| format.name == name) {
            return Some(formats::target(format, folder));
        }
        OTHERS.iter().find(|other| other.0 == name).map(|other| other.1(folder))
    }

    /// Reads a file. An error is a fault of the reader, such as a message of several lines.
    pub fn read(&self, bytes: &[u8]) -> Result<(), String> {
        (self.read)(bytes)
    }
}

/// The value, or `None` if there is an error, whose message is checked.
fn checked<T>(read: Result<T, impl Display>) -> Result<Option<T>, String> {
    match read {
        Ok(value) => Ok(Some(value)),
        Err(error) => check_message([error.to_string()]).map(|()| None),
    }
}

/// Checks that each message is one line that a terminal can show unchanged.
pub(crate) fn check_message(messages: impl IntoIterator<Item = String>) -> Result<(), String> {
    for message in messages {
        if message.is_empty() || message.contains(is_control) {
            return Err(format!("a message is empty or has control characters: {message:?}"));
        }
        if message.len() > 10_000 {
            return Err(format!("a message has {} bytes: {:.200}", message.len(), message));
        }
    }
    Ok(())
}
