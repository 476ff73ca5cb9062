//! Finds and reads the frames of a file with the functions of its format.

use std::io;

use super::error::LoadError;
use super::format::{FrameIndex, Frames, Options};
use super::frame::FrameText;
use super::line_reader::LineReader;
use super::loaded::Loaded;
use super::source::{Bytes, bytes};
use super::topology::Topology;

impl Frames {
    /// Finds frames. An index has at least one. Positions alone need a topology.
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
            (_, Some(reader)) => reader.read(source, wanted, span, options)?,
            (_, None) => return Err(LoadError::no_such_frame(wanted, 0)),
        };
        loaded.notes.extend_from_slice(&index.notes);
        loaded.frames = index.is_whole.then_some(frames);
        Ok(loaded)
    }
}

/// Reads the frame that the options name, or else the first, of a file that is in memory. Positions alone need a
/// topology.
pub(super) fn read_from_memory(
    bytes: &[u8],
    frames: Frames,
    options: &Options,
    topology: Option<Topology>,
) -> Result<Loaded, LoadError> {
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
    /// A frame, with a note on what is wrong after the last one; or else this as an error, because a wrong number of atoms
    /// in a text makes what follows them wrong.
    pub(super) fn with_problem(self, mut loaded: Loaded) -> Result<Loaded, LoadError> {
        match self.problem {
            Some(problem) if self.stands_alone => loaded.notes.push(problem.to_string()),
            Some(problem) => return Err(problem),
            None => {}
        }
        Ok(loaded)
    }
}
