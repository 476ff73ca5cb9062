//! Files with several frames, of which one at a time is in memory.
#![cfg_attr(
    not(all(feature = "pdb", feature = "xyz")),
    allow(dead_code, reason = "some formats with frames are left out")
)]

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::error::LoadError;
use super::format::{Format, Options};
use super::loaded::Loaded;

/// How much of a file is read at a time while its frames are found.
const PIECE: usize = 1 << 18;

/// How a format with several frames finds and reads them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frames {
    /// Finds all frames, or those up to one that is wanted.
    pub(super) find: fn(&mut LineReader<'_>, Option<usize>) -> io::Result<FrameIndex>,
    pub(super) read: fn(&FrameText<'_>) -> Result<Loaded, LoadError>,
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
    file: File,
    frames: Frames,
    index: FrameIndex,
}

impl Trajectory {
    /// Opens a file and finds its frames, in one pass over the file. Its format is the one in the options, or else
    /// follows from the extension, or else from the content.
    ///
    /// If the file ends within a frame, as where a program is still writing, the frames before it can be read, and
    /// [`Trajectory::problem`] says what is wrong.
    ///
    /// # Errors
    /// If the file cannot be read, its format is not known or has no frames, or not even the first frame is complete.
    pub fn open(path: impl AsRef<Path>, options: &Options) -> Result<Self, LoadError> {
        Self::find(path.as_ref(), options.format, None)
    }

    /// Opens a file like [`Trajectory::open`], and finds its frames up to the one in the options or else the first.
    ///
    /// # Errors
    /// If there is no such frame, or for the reasons of [`Trajectory::open`].
    pub fn open_up_to(path: impl AsRef<Path>, options: &Options) -> Result<Self, LoadError> {
        let wanted = options.frame.unwrap_or_default();
        let found = Self::find(path.as_ref(), options.format, Some(wanted))?;
        let frames = found.len();
        if wanted < frames {
            return Ok(found);
        }
        Err(found.index.problem.unwrap_or(LoadError::NoSuchFrame { wanted, frames }))
    }

    fn find(
        path: &Path,
        format: Option<&'static Format>,
        last: Option<usize>,
    ) -> Result<Self, LoadError> {
        let failed = |error| LoadError::File { path: path.to_path_buf(), error };
        let file = File::open(path).map_err(failed)?;
        let mut reader = BufReader::with_capacity(PIECE, file);
        let format = match format {
            Some(format) => format,
            None => Format::of_file(path, reader.fill_buf().map_err(failed)?)?,
        };
        let frames = format.frames.ok_or(LoadError::NoFrames { format: format.name })?;
        let mut index = (frames.find)(&mut LineReader::new(&mut reader), last).map_err(failed)?;
        match index.problem.take() {
            Some(problem) if index.frames.is_empty() => return Err(problem),
            problem => index.problem = problem,
        }
        Ok(Self { path: path.to_path_buf(), file: reader.into_inner(), frames, index })
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
        let frames = self.len();
        let Some(FrameSpan { bytes, lines_before }) = self.index.frames.get(index).cloned() else {
            return Err(LoadError::NoSuchFrame { wanted: index, frames });
        };
        let head = self.bytes(self.index.head.clone())?;
        let text = self.bytes(bytes)?;
        let text = FrameText { head: &head, text: &text, lines_before, index };
        let mut loaded = (self.frames.read)(&text)?;
        loaded.frames = self.index.is_whole.then_some(frames);
        Ok(loaded)
    }

    fn bytes(&mut self, range: Range<u64>) -> Result<Vec<u8>, LoadError> {
        let mut bytes = Vec::new();
        let length = range.end - range.start;
        let seek = self.file.seek(SeekFrom::Start(range.start));
        let read = seek.and_then(|_| (&mut self.file).take(length).read_to_end(&mut bytes));
        match read {
            Ok(read) if read as u64 == length => Ok(bytes),
            Ok(_) => Err(io::ErrorKind::UnexpectedEof.into()),
            Err(error) => Err(error),
        }
        .map_err(|error| LoadError::File { path: self.path.clone(), error })
    }

    /// Reads one frame, counted from 0, where what follows the frames that were found must be another frame or the end
    /// of the file: so a wrong number of atoms is noticed.
    ///
    /// # Errors
    /// As [`Trajectory::frame`], and then [`Trajectory::problem`].
    pub fn into_frame(mut self, index: usize) -> Result<Loaded, LoadError> {
        let loaded = self.frame(index)?;
        self.index.problem.map_or(Ok(loaded), Err)
    }
}

/// The lines of a file that need not fit into memory.
pub(super) struct LineReader<'a> {
    source: &'a mut dyn BufRead,
    /// Bytes so far.
    pub(super) offset: u64,
    /// Lines so far.
    pub(super) line: usize,
    text: Vec<u8>,
}

impl<'a> LineReader<'a> {
    pub(super) fn new(source: &'a mut dyn BufRead) -> Self {
        Self { source, offset: 0, line: 0, text: Vec::new() }
    }

    /// Returns the next line without its line end; `None` at the end of the file. Of a line longer than 1 KiB only the
    /// start.
    pub(super) fn next(&mut self) -> io::Result<Option<&[u8]>> {
        const LONGEST: u64 = 1 << 10;
        self.text.clear();
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

    /// Skips lines, and returns how many there were.
    #[cfg(feature = "xyz")]
    pub(super) fn skip(&mut self, lines: usize) -> io::Result<usize> {
        for found in 0..lines {
            let read = self.source.skip_until(b'\n')?;
            if read == 0 {
                return Ok(found);
            }
            self.offset += read as u64;
            self.line += 1;
        }
        Ok(lines)
    }
}
