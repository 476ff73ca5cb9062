//! A frame of a file: where it is, and its text.

use std::ops::Range;

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
