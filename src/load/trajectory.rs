//! Files with several frames, of which one at a time is in memory.
#![cfg_attr(
    not(all(feature = "gsd", feature = "pdb", feature = "xyz")),
    allow(dead_code, reason = "some formats with frames are left out")
)]

use std::fmt;
use std::io::{self, BufRead, Read as _, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::error::{LoadError, LoadErrorKind};
use super::format::{Format, Options};
use super::loaded::Loaded;
use super::source::{Bytes, Source};

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
}

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

impl Frames {
    /// Finds frames. An index has at least one.
    fn find(
        self,
        source: &mut dyn Bytes,
        last: Option<usize>,
        options: &Options,
    ) -> Result<FrameIndex, LoadError> {
        let mut index = match self {
            Self::Lines { find, .. } => find(&mut LineReader::new(source), last)?,
            Self::Bytes { find } => find(source, last, options)?,
        };
        match index.problem.take() {
            Some(problem) if index.frames.is_empty() => return Err(problem),
            problem => index.problem = problem,
        }
        Ok(index)
    }

    /// Reads one frame, counted from 0.
    fn read(
        self,
        source: &mut dyn Bytes,
        index: &FrameIndex,
        wanted: usize,
        options: &Options,
    ) -> Result<Loaded, LoadError> {
        let frames = index.frames.len();
        let Some(span) = index.frames.get(wanted) else {
            return Err(LoadError::no_such_frame(wanted, frames));
        };
        let mut loaded = match (self, &index.reader) {
            (Self::Lines { read, .. }, _) => {
                let head = bytes(source, &index.head)?;
                let text = bytes(source, &span.bytes)?;
                let lines_before = span.lines_before;
                let text = FrameText { head: &head, text: &text, lines_before, index: wanted };
                read(&text, options)?
            }
            (Self::Bytes { .. }, Some(reader)) => reader.read(source, wanted, span, options)?,
            (Self::Bytes { .. }, None) => return Err(LoadError::no_such_frame(wanted, 0)),
        };
        loaded.notes.extend_from_slice(&index.notes);
        loaded.frames = index.is_whole.then_some(frames);
        Ok(loaded)
    }
}

/// Reads a range of the bytes of a file.
pub(super) fn bytes(source: &mut dyn Bytes, range: &Range<u64>) -> Result<Vec<u8>, LoadError> {
    /// More is allocated as it arrives, because a file may lie about its frames.
    const AT_ONCE: u64 = 1 << 26;
    let length = range.end - range.start;
    let mut bytes = Vec::with_capacity(length.min(AT_ONCE) as usize);
    source.seek(SeekFrom::Start(range.start))?;
    if source.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
    }
    Ok(bytes)
}

/// Reads the frame that the options name, or else the first, of a file that is in memory.
pub(super) fn read_from_memory(
    bytes: &[u8],
    frames: Frames,
    options: &Options,
) -> Result<Loaded, LoadError> {
    let wanted = options.frame.unwrap_or_default();
    let mut source = io::Cursor::new(bytes);
    let index = frames.find(&mut source, None, options)?;
    if wanted >= index.frames.len()
        && let Some(problem) = index.problem
    {
        return Err(problem);
    }
    let loaded = frames.read(&mut source, &index, wanted, options)?;
    index.with_problem(loaded)
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

impl FrameIndex {
    /// A frame, with a note on what is wrong after the last one; or else this as an error, because a wrong number of atoms
    /// in a text makes what follows them wrong.
    fn with_problem(self, mut loaded: Loaded) -> Result<Loaded, LoadError> {
        match self.problem {
            Some(problem) if self.stands_alone => loaded.notes.push(problem.to_string()),
            Some(problem) => return Err(problem),
            None => {}
        }
        Ok(loaded)
    }
}

/// Where a frame is in its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FrameSpan {
    pub(super) bytes: Range<u64>,
    /// Number of lines before the frame.
    pub(super) lines_before: usize,
}

/// The text of one frame.
#[derive(Debug)]
pub(super) struct FrameText<'a> {
    pub(super) head: &'a [u8],
    pub(super) text: &'a [u8],
    pub(super) lines_before: usize,
    /// Index of the frame, from 0.
    pub(super) index: usize,
}

/// A file of several frames. [`Trajectory::frame`] reads one of them; the others are not in memory.
#[derive(Debug)]
pub struct Trajectory {
    path: PathBuf,
    source: Source,
    frames: Frames,
    index: FrameIndex,
    options: Options,
}

impl Trajectory {
    /// Opens a file and finds its frames, in one pass over the file. Its format is the one in the options, or else
    /// follows from the extension, or else from the content. The other options apply to every frame.
    ///
    /// If the file ends within a frame, as where a program is still writing, the frames before it can be read, and
    /// [`Trajectory::problem`] says what is wrong.
    ///
    /// # Errors
    /// If the file cannot be read, its format is not known or has no frames, an option does not apply to it, or not even
    /// the first frame is complete.
    pub fn open(path: impl AsRef<Path>, options: &Options) -> Result<Self, LoadError> {
        Self::find(path.as_ref(), options, None)
    }

    /// Opens a file like [`Trajectory::open`], and finds its frames up to the one in the options or else the first.
    ///
    /// # Errors
    /// If there is no such frame, or for the reasons of [`Trajectory::open`].
    pub fn open_up_to(path: impl AsRef<Path>, options: &Options) -> Result<Self, LoadError> {
        let wanted = options.frame.unwrap_or_default();
        let found = Self::find(path.as_ref(), options, Some(wanted))?;
        let frames = found.len();
        if wanted < frames {
            return Ok(found);
        }
        let none = || LoadError::no_such_frame(wanted, frames);
        Err(found.index.problem.unwrap_or_else(none))
    }

    fn find(path: &Path, options: &Options, last: Option<usize>) -> Result<Self, LoadError> {
        let of_file = |error: LoadError| error.in_file(path);
        let mut source = Source::open(path).map_err(|error| of_file(error.into()))?;
        let format = match options.format {
            Some(format) => format,
            None => {
                let first = source.fill_buf().map_err(|error| of_file(error.into()))?;
                Format::of_file(path, first)?
            }
        };
        format.check(options)?;
        let frames = format.frames.ok_or_else(|| {
            let name = format.name;
            let message = format!("a file of the format {name} has no frames; read it as a whole");
            LoadError::new(message).of_kind(LoadErrorKind::NoFrames)
        })?;
        if matches!(frames, Frames::Bytes { .. }) {
            source = source.in_small_pieces().map_err(|error| of_file(error.into()))?;
        }
        let index = frames.find(&mut source, last, options).map_err(of_file)?;
        let options = Options { format: Some(format), frame: None, ..options.clone() };
        Ok(Self { path: path.to_path_buf(), source, frames, index, options })
    }

    /// Number of frames that are complete.
    #[must_use]
    pub fn len(&self) -> usize {
        self.index.frames.len()
    }

    /// Always false: a trajectory has at least one frame.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.index.frames.is_empty()
    }

    /// What is wrong after the last complete frame, if anything is.
    #[must_use]
    pub fn problem(&self) -> Option<&LoadError> {
        self.index.problem.as_ref()
    }

    /// How many bytes a frame has in the file; `None` if there is no such frame.
    #[must_use]
    pub fn frame_bytes(&self, index: usize) -> Option<u64> {
        self.index.frames.get(index).map(|span| span.bytes.end - span.bytes.start)
    }

    /// Reads one frame, counted from 0.
    ///
    /// # Errors
    /// If there is no such frame, or it cannot be read. Lines are counted from the start of the file.
    pub fn frame(&mut self, index: usize) -> Result<Loaded, LoadError> {
        let Self { path, source, frames, index: found, options } = self;
        frames.read(source, found, index, options).map_err(|error| error.in_file(path))
    }

    /// Reads one frame, counted from 0, where what follows the frames that were found must be another frame or the end
    /// of the file: so a wrong number of atoms is noticed. Of binary data, where it need not be, a note says what is wrong.
    ///
    /// # Errors
    /// As [`Trajectory::frame`], and then [`Trajectory::problem`].
    pub fn into_frame(mut self, index: usize) -> Result<Loaded, LoadError> {
        let loaded = self.frame(index)?;
        self.index.with_problem(loaded)
    }
}

/// The lines of a file that need not fit into memory.
pub(super) struct LineReader<'a> {
    source: &'a mut dyn Bytes,
    /// Bytes so far.
    pub(super) offset: u64,
    /// Lines so far.
    pub(super) line: usize,
    text: Vec<u8>,
}

impl<'a> LineReader<'a> {
    pub(super) fn new(source: &'a mut dyn Bytes) -> Self {
        Self { source, offset: 0, line: 0, text: Vec::new() }
    }

    /// Returns the next line without its line end; `None` at the end of the file. Of a line longer than 1 KiB only the
    /// start.
    #[cfg(feature = "table")]
    pub(super) fn next(&mut self) -> io::Result<Option<&[u8]>> {
        const LONGEST: u64 = 1 << 10;
        self.text.clear();
        // Most lines are short and lie in what has been read.
        let buffer = self.source.fill_buf()?;
        let near = &buffer[..buffer.len().min(LONGEST as usize)];
        if let Some(end) = memchr::memchr(b'\n', near) {
            self.text.extend_from_slice(&near[..end]);
            self.source.consume(end + 1);
            self.offset += end as u64 + 1;
            self.line += 1;
            return Ok(Some(&self.text));
        }
        let read = (&mut *self.source).take(LONGEST).read_until(b'\n', &mut self.text)?;
        if read == 0 {
            return Ok(None);
        }
        self.offset += read as u64;
        self.line += 1;
        if self.text.last() == Some(&b'\n') {
            self.text.pop();
        } else {
            self.offset += self.source.skip_until(b'\n')? as u64;
        }
        Ok(Some(&self.text))
    }

    /// Skips lines, and returns how many there were. The last may lack a line end.
    #[cfg(feature = "table")]
    pub(super) fn skip(&mut self, lines: usize) -> io::Result<usize> {
        const BLOCK: usize = 1 << 13;
        let (mut found, mut is_within) = (0, false);
        while found < lines {
            let buffer = self.source.fill_buf()?;
            if buffer.is_empty() {
                found += usize::from(is_within);
                break;
            }
            // Counting is faster than looking at every line, but where a frame ends is not known.
            let block = &buffer[..buffer.len().min(BLOCK)];
            let wanted = lines - found;
            let count = memchr::memchr_iter(b'\n', block).count();
            let last = if count < wanted {
                None
            } else {
                memchr::memchr_iter(b'\n', block).nth(wanted - 1)
            };
            let end = last.map_or(block.len(), |last| last + 1);
            is_within = block[end - 1] != b'\n';
            found += count.min(wanted);
            self.offset += end as u64;
            self.source.consume(end);
        }
        self.line += found;
        Ok(found)
    }
}
