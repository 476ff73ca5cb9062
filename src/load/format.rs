//! A file format as plain data: its names, how its bytes and frames are read, and the options for that.

use std::fmt;
use std::io;
use std::ops::Range;
use std::path::PathBuf;

use super::error::LoadError;
use super::frame::{FrameSpan, FrameText};
use super::gzip;
use super::line_reader::LineReader;
use super::loaded::Loaded;
use super::source::Bytes;
use super::topology::Topology;

/// A file format for spheres.
#[derive(Debug)]
#[non_exhaustive]
pub struct Format {
    /// Name of the format, such as `extxyz`.
    pub name: &'static str,
    /// File name extensions of the format, in lower case and without the dot.
    pub extensions: &'static [&'static str],
    /// Contents of such a file, in a few words for users.
    pub about: &'static str,
    /// How a file is read.
    pub(super) reading: Reading,
    /// Whether a file has positions alone, so that [`Options::topology`] names a file that says what the spheres are.
    pub needs_topology: bool,
    /// Whether a file can lack names for its columns, so that [`Options::columns`] gives them.
    pub may_lack_names: bool,
    /// Whether a file can lack radii, so that [`Options::radius`] gives one for all spheres.
    pub may_lack_radii: bool,
    /// Whether a file gives colours, either directly or through the elements of its atoms.
    pub has_colors: bool,
    /// Whether z is the height in most files of this format, as in simulations and surveys. Of molecules and models of
    /// surfaces, y is up on the screen.
    pub z_is_up: bool,
    /// Whether the first bytes of a file look like this format.
    pub(super) starts: fn(&[u8]) -> bool,
    pub(super) extra_bytes: fn(&[u8]) -> Result<u64, LoadError>,
}

/// How a file of a format is read.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reading {
    /// As a whole.
    Whole(fn(&[u8], &Options) -> Result<Loaded, LoadError>),
    /// Frame by frame, because a file can have several.
    Frames(Frames),
}

/// How a format with several frames finds and reads them.
#[derive(Clone, Copy, Debug)]
pub(super) enum Frames {
    /// Text: frames are found line by line, and each is one piece of the file.
    Lines {
        /// Finds all frames, or those up to one that is wanted.
        find: fn(&mut LineReader<'_>, Option<usize>) -> io::Result<FrameIndex>,
        read: fn(&FrameText<'_>, &Options) -> Result<Loaded, LoadError>,
    },
    /// Binary data, where a reader goes to any place.
    Bytes {
        /// Finds all frames, or those up to one that is wanted, and gives the index a reader. What is wrong after some
        /// frames is the problem of the index, not an error.
        find: fn(&mut dyn Bytes, Option<usize>, &Options) -> Result<FrameIndex, LoadError>,
    },
    /// The same of positions alone, where another file, the topology, says what the spheres are.
    Positions {
        /// Finds all frames, or those up to one that is wanted; an error if there is no topology.
        find: FindPositions,
    },
}

/// Finds frames of positions alone, which the topology completes.
pub(super) type FindPositions =
    fn(&mut dyn Bytes, Option<usize>, Option<Topology>) -> Result<FrameIndex, LoadError>;

/// Reads frames of binary data, with what was found out about the file.
pub(super) trait FrameReader: fmt::Debug + Send + Sync {
    /// Reads one frame that the index has, counted from 0.
    fn read(
        &self,
        source: &mut dyn Bytes,
        frame: usize,
        span: &FrameSpan,
        options: &Options,
    ) -> Result<Loaded, LoadError>;
}

/// Where the frames of a file are.
#[derive(Debug, Default)]
pub(super) struct FrameIndex {
    /// Bytes before the first frame that every frame needs.
    pub(super) head: Range<u64>,
    pub(super) frames: Vec<FrameSpan>,
    /// Whether the file was searched to its end.
    pub(super) is_whole: bool,
    /// What is wrong after the last frame, as where a program is still writing.
    pub(super) problem: Option<LoadError>,
    /// Whether a complete frame is right whatever follows it, as in binary data that say how long they are.
    pub(super) stands_alone: bool,
    /// Notes for the user on every frame.
    pub(super) notes: Vec<String>,
    /// Reads the frames, if they are binary data.
    pub(super) reader: Option<Box<dyn FrameReader>>,
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
    /// The file that says what the spheres of a trajectory are, for formats that have positions alone.
    pub topology: Option<PathBuf>,
    /// The names of the columns, in the order of the file, for tables without a header; empty if there is one.
    pub columns: Vec<String>,
}

impl Format {
    /// Whether a file can have several frames, which [`Trajectory`](super::Trajectory) reads one by one.
    #[must_use]
    pub const fn has_frames(&self) -> bool {
        matches!(self.reading, Reading::Frames(_))
    }

    /// Returns how many bytes of memory reading takes in addition to the file itself, or 0 if the file does not say.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn extra_bytes(&self, bytes: &[u8]) -> Result<u64, LoadError> {
        if gzip::starts(bytes) {
            return Ok(gzip::size_hint(bytes));
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
    /// Returns these options with a format.
    #[must_use]
    pub fn with_format(self, format: &'static Format) -> Self {
        Self { format: Some(format), ..self }
    }

    /// Returns these options with a frame of a trajectory, counted from 0.
    #[must_use]
    pub fn with_frame(self, frame: usize) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Returns these options with the file that says what the spheres of a trajectory are.
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
