//! A file format as plain data: its names, its functions that read bytes and frames, and the options for reading.

use std::ops::Range;
use std::path::PathBuf;
use std::{fmt, io};

use super::compressed::{Compression, size_hint};
use super::dataset::Dataset;
use super::error::LoadError;
use super::source::{Bytes, LineReader, bytes};
use super::topology::Topology;

/// A file format for spheres.
#[derive(Debug)]
#[non_exhaustive]
pub struct Format {
    /// Name of the format, such as `extxyz`.
    pub name: &'static str,
    /// File name extensions of the format, in lower case and without the dot.
    pub extensions: &'static [&'static str],
    /// Starts of the names of files that have no extension, such as `POSCAR`.
    pub file_names: &'static [&'static str],
    /// Contents of a file of this format, in a few words for users.
    pub about: &'static str,
    pub(super) method: ReadMethod,
    /// Whether a file has positions alone, so that [`Options::topology`] must name a file that describes the spheres.
    pub needs_topology: bool,
    /// Whether a file can lack names for its columns, so that [`Options::columns`] may give them.
    pub may_lack_names: bool,
    /// Whether a file can lack radii, so that [`Options::radius`] may give one for all spheres.
    pub may_lack_radii: bool,
    /// Whether a file gives colours, either directly or through the elements of its atoms.
    pub has_colors: bool,
    /// Whether z is the height in most files of this format, as in simulations and surveys. In pictures of molecules
    /// and surface models, y is up.
    pub z_is_up: bool,
    /// Whether the file is text, which has no zero byte.
    pub(super) is_text: bool,
    /// Whether the first bytes of a file look like this format.
    pub(super) starts: fn(&[u8]) -> bool,
    pub(super) extra_bytes: fn(&[u8]) -> Result<u64, LoadError>,
    /// The plain array of spheres of a file, by its first bytes and its length.
    pub(super) rows: fn(&[u8], u64, &Options) -> Option<Rows>,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum ReadMethod {
    /// The file is read as a whole.
    Whole(fn(&[u8], &Options) -> Result<Dataset, LoadError>),
    /// The file is read frame by frame, because it can have several.
    Frames(Frames),
}

/// The functions with which a format finds and reads frames.
#[derive(Clone, Copy, Debug)]
pub(super) enum Frames {
    /// Text: frames are found line by line, and each is a contiguous part of the file.
    Lines {
        /// Finds all frames, or those up to a wanted one.
        find: fn(&mut LineReader<'_>, Option<usize>) -> io::Result<FrameIndex>,
        read: fn(&FrameText<'_>, &Options) -> Result<Dataset, LoadError>,
    },
    /// Binary data, where a reader can go to any place.
    Bytes {
        /// Finds all frames, or those up to a wanted one, and gives the index a reader. A fault after some frames is
        /// the problem of the index, not an error.
        find: fn(&mut dyn Bytes, Option<usize>, &Options) -> Result<FrameIndex, LoadError>,
    },
    /// Binary data with positions alone. Another file, the topology, describes the spheres.
    Positions {
        /// Finds all frames, or those up to a wanted one. Without a topology it returns an error.
        find: FindPositions,
    },
}

type FindPositions = fn(&mut dyn Bytes, Option<usize>, Option<Topology>) -> Result<FrameIndex, LoadError>;

/// Reads frames of binary data, with the facts that are known about the file.
pub(super) trait FrameReader: fmt::Debug + Send + Sync {
    /// Reads one frame that the index has, counted from 0.
    fn read(
        &self,
        source: &mut dyn Bytes,
        frame: usize,
        span: &FrameSpan,
        options: &Options,
    ) -> Result<Dataset, LoadError>;
}

#[derive(Debug, Default)]
pub(super) struct FrameIndex {
    /// Range of bytes before the first frame that every frame needs.
    pub(super) head: Range<u64>,
    /// Lines after the last frame that every frame needs.
    pub(super) tail: FrameSpan,
    pub(super) frames: Vec<FrameSpan>,
    /// Whether the file was searched to its end.
    pub(super) is_whole: bool,
    /// The fault after the last frame, such as where a program is still writing.
    pub(super) problem: Option<LoadError>,
    /// Whether a complete frame is valid whatever follows it, as in binary data that declare their length.
    pub(super) stands_alone: bool,
    pub(super) notes: Vec<String>,
    /// The reader of the frames, if they are binary data.
    pub(super) reader: Option<Box<dyn FrameReader>>,
}

/// The type of the numbers of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbers {
    F32,
    F64,
}

/// The place of an array of little-endian numbers in a file, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rows {
    /// Byte of the first row.
    pub(super) first: u64,
    pub(super) count: usize,
    /// 3 for x, y, z, or 4 for x, y, z, radius.
    pub(super) columns: usize,
    pub(super) numbers: Numbers,
}

impl Rows {
    /// Number of bytes of the rows in the file; `None` if there are more than any file has.
    pub(super) fn bytes(&self) -> Option<u64> {
        (self.count as u64).checked_mul(self.columns as u64 * self.numbers.width())
    }
}

impl Numbers {
    pub(super) const fn width(self) -> u64 {
        match self {
            Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// Options for reading a file of spheres.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The format; `None` chooses it by the name or the content of the file.
    pub format: Option<&'static Format>,
    /// The frame of a trajectory to read, counted from 0; `None` reads the first.
    pub frame: Option<usize>,
    /// The radius of all spheres, in the file's unit of length, for files without radii.
    pub radius: Option<f64>,
    /// The file that describes the spheres of a trajectory, for formats that have positions alone.
    pub topology: Option<PathBuf>,
    /// The names of the columns, in the order of the file, for tables without a header; empty if there is one.
    pub columns: Vec<String>,
}

impl Format {
    /// Returns true if a file can have several frames, which [`Trajectory`](super::Trajectory) reads one by one.
    #[must_use]
    pub const fn has_frames(&self) -> bool {
        matches!(self.method, ReadMethod::Frames(_))
    }

    /// Returns the bytes of memory that reading takes in addition to the file itself, or 0 if the file does not say.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn extra_bytes(&self, bytes: &[u8]) -> Result<u64, LoadError> {
        if let Some(compression) = Compression::of(bytes) {
            return Ok(size_hint(bytes, compression));
        }
        (self.extra_bytes)(bytes)
    }
}

impl Eq for Format {}

impl PartialEq for Format {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Options {
    /// Returns these options with another format.
    #[must_use]
    pub fn with_format(self, format: &'static Format) -> Self {
        Self { format: Some(format), ..self }
    }

    /// Returns these options with another frame of a trajectory, counted from 0.
    #[must_use]
    pub fn with_frame(self, frame: usize) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Returns these options with the file that describes the spheres of a trajectory.
    #[must_use]
    pub fn with_topology(self, path: impl Into<PathBuf>) -> Self {
        Self { topology: Some(path.into()), ..self }
    }

    /// Returns these options with the names of the columns of a table without a header.
    #[must_use]
    pub fn with_columns(self, columns: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { columns: columns.into_iter().map(Into::into).collect(), ..self }
    }

    /// Returns these options with one radius for all spheres, for files without radii.
    #[must_use]
    pub fn with_radius(self, radius: f64) -> Self {
        Self { radius: Some(radius), ..self }
    }
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct FrameSpan {
    pub(super) bytes: Range<u64>,
    pub(super) lines_before: usize,
}

#[derive(Debug)]
pub(super) struct FrameText<'a> {
    pub(super) head: &'a [u8],
    pub(super) text: &'a [u8],
    pub(super) lines_before: usize,
    pub(super) tail: &'a [u8],
    /// Number of lines before the tail.
    pub(super) lines_before_tail: usize,
    /// Index of the frame, from 0.
    pub(super) index: usize,
}

impl Frames {
    /// Finds frames; the index has at least one. Formats with positions alone need a topology.
    pub(super) fn find(
        self,
        source: &mut dyn Bytes,
        last: Option<usize>,
        options: &Options,
        topology: Option<Topology>,
    ) -> Result<FrameIndex, LoadError> {
        let mut index = match self {
            Self::Lines { find, .. } => find(&mut LineReader::new(source), last)?,
            Self::Bytes { find } => find(source, last, options)?,
            Self::Positions { find } => find(source, last, topology)?,
        };
        match index.problem.take() {
            Some(problem) if index.frames.is_empty() => return Err(problem),
            problem => index.problem = problem,
        }
        Ok(index)
    }

    /// Reads one frame, counted from 0.
    pub(super) fn read(
        self,
        source: &mut dyn Bytes,
        index: &FrameIndex,
        wanted: usize,
        options: &Options,
    ) -> Result<Dataset, LoadError> {
        let frames = index.frames.len();
        let Some(span) = index.frames.get(wanted) else {
            return Err(LoadError::no_such_frame(wanted, frames));
        };
        let mut loaded = match (self, &index.reader) {
            (Self::Lines { read, .. }, _) => {
                let head = bytes(source, &index.head)?;
                let text = bytes(source, &span.bytes)?;
                let tail = bytes(source, &index.tail.bytes)?;
                let text = FrameText {
                    head: &head,
                    text: &text,
                    lines_before: span.lines_before,
                    tail: &tail,
                    lines_before_tail: index.tail.lines_before,
                    index: wanted,
                };
                read(&text, options)?
            }
            (_, Some(reader)) => reader.read(source, wanted, span, options)?,
            (_, None) => return Err(LoadError::no_such_frame(wanted, 0)),
        };
        loaded.notes.extend_from_slice(&index.notes);
        loaded.frames = index.is_whole.then_some(frames);
        Ok(loaded)
    }
}

/// Reads a file that is in memory: the frame that the options name, or else the first. Formats with positions
/// alone need a topology.
pub(super) fn read_from_memory(
    bytes: &[u8],
    frames: Frames,
    options: &Options,
    topology: Option<Topology>,
) -> Result<Dataset, LoadError> {
    let wanted = options.frame.unwrap_or_default();
    let mut source = io::Cursor::new(bytes);
    let index = frames.find(&mut source, None, options, topology)?;
    if wanted >= index.frames.len()
        && let Some(problem) = index.problem
    {
        return Err(problem);
    }
    let loaded = frames.read(&mut source, &index, wanted, options)?;
    index.with_problem(loaded)
}

impl FrameIndex {
    /// Returns the frame with a note on the fault after the last frame. In text the fault is an error, because a wrong
    /// number of atoms makes everything after it wrong.
    pub(super) fn with_problem(self, mut loaded: Dataset) -> Result<Dataset, LoadError> {
        match self.problem {
            Some(problem) if self.stands_alone => loaded.notes.push(problem.to_string()),
            Some(problem) => return Err(problem),
            None => {}
        }
        Ok(loaded)
    }
}
