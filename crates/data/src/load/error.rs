//! The error of reading files.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// An error of reading a file: what is wrong, and where. Its text has one line. It names the line, column or byte, but
/// not the file, which the caller knows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// The kind of error, for programs that treat some kinds differently.
    pub kind: LoadErrorKind,
    /// The place in the file that is wrong.
    pub place: Place,
    /// The description of what is wrong, often with advice.
    pub message: String,
}

/// Kinds of errors that programs handle differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadErrorKind {
    /// The operating system could not read the bytes; the message is its own.
    Io,
    /// The file ends too early.
    CutOff,
    /// The format has no frames, so the file must be read as a whole.
    NoFrames,
    /// The file has positions alone, so a topology must be given.
    NoTopology,
    /// No columns are positions.
    NoPositions,
    /// The file has radii, and a radius was given as well.
    TwoRadii,
    /// The file is wrong in another way.
    Other,
}

/// A place in a file. Lines and columns are counted from 1; bytes, rows and pieces from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole, or its end.
    Whole,
    /// The file with this path.
    File(PathBuf),
    /// A line.
    Line(usize),
    /// A column of a line: a letter or a value.
    Column {
        /// The line.
        line: usize,
        /// The column.
        column: usize,
    },
    /// Several columns of a line, which are letters.
    Columns {
        /// The line.
        line: usize,
        /// The first column.
        first: usize,
        /// The last column.
        last: usize,
    },
    /// A byte.
    Byte(u64),
    /// A row of a table or an array.
    Row(usize),
    /// A piece of a VTK file.
    Piece(usize),
    /// An array of an archive.
    Array(String),
}

impl LoadError {
    /// An error of the file as a whole.
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        Self::at(Place::Whole, message)
    }

    pub(crate) fn at(place: Place, message: impl Into<String>) -> Self {
        Self { kind: LoadErrorKind::Other, place, message: message.into() }
    }

    pub(crate) fn line(line: usize, message: impl Into<String>) -> Self {
        Self::at(Place::Line(line), message)
    }

    pub(crate) fn byte(byte: u64, message: impl Into<String>) -> Self {
        Self::at(Place::Byte(byte), message)
    }

    /// Returns this error with another kind.
    #[must_use]
    pub fn of_kind(self, kind: LoadErrorKind) -> Self {
        Self { kind, ..self }
    }

    pub(crate) fn no_such_frame(wanted: usize, frames: usize) -> Self {
        let name = if frames == 1 { "frame" } else { "frames" };
        let have = format!("the file has {frames} {name}, counted from 0");
        Self::new(format!("there is no frame {wanted}; {have}"))
    }

    /// Puts the path into an error of the operating system.
    pub(crate) fn in_file(self, path: &Path) -> Self {
        match self.kind {
            LoadErrorKind::Io => Self { place: Place::File(path.to_path_buf()), ..self },
            _ => self,
        }
    }
}

impl From<io::Error> for LoadError {
    fn from(error: io::Error) -> Self {
        Self::new(error.to_string()).of_kind(LoadErrorKind::Io)
    }
}

impl std::error::Error for LoadError {}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, place, message } = self;
        match (kind, place) {
            (LoadErrorKind::Io, Place::Whole) => write!(f, "the file cannot be read: {message}"),
            (LoadErrorKind::Io, place) => write!(f, "{place}cannot be read: {message}"),
            _ => write!(f, "{place}{message}"),
        }
    }
}

/// The first five names, and the number of further names.
pub(super) fn first_names(names: impl ExactSizeIterator<Item = String>) -> String {
    const MOST: usize = 5;
    let more = names.len().saturating_sub(MOST);
    let named = names.take(MOST).collect::<Vec<_>>().join(", ");
    if more == 0 { named } else { format!("{named} and {more} more") }
}

/// Formats the place as it stands before a message.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::File(path) => write!(f, "{}: ", path.display()),
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Column { line, column } => write!(f, "line {line}, column {column}: "),
            Self::Columns { line, first, last } => {
                write!(f, "line {line}, columns {first}-{last}: ")
            }
            Self::Byte(byte) => write!(f, "byte {byte}: "),
            Self::Row(row) => write!(f, "row {row}: "),
            Self::Piece(piece) => write!(f, "piece {piece}: "),
            Self::Array(name) => write!(f, "array `{name}`: "),
        }
    }
}
