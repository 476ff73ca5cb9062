//! What a host learns of a lit picture.

use wgpu::Buffer;

/// What a recording has done for a lit picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LitProgress {
    /// Number of samples that every pixel has when the recording has been executed. Some may have more. With 0, the
    /// colours may be those of primary rays, or of the view before.
    pub samples: u32,
    /// Number of samples that the picture will have.
    pub total: u32,
    /// Number of rays that the recorded commands trace at most.
    pub rays: u64,
    /// What the next recording will do.
    pub state: LitState,
    /// Whether commands of an earlier recording were not executed, or not in order, so that the samples accumulate from
    /// the first one again.
    pub was_lost: bool,
}

/// The state of a lit picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LitState {
    /// More samples remain.
    Refining,
    /// All samples are recorded, and nothing remains to do until something changes.
    Done,
    /// The device has not finished the recordings before, so nothing was recorded.
    Waiting,
}

/// The accumulated sums of a part of a picture.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct LitSums<'a> {
    /// First column and row of the part, in pixels.
    pub origin: [u32; 2],
    /// Width and height of the part, in pixels.
    pub size: [u32; 2],
    /// Buffer with three `vec4f` for each pixel, row by row: the sums of colour and opacity; the rounding errors of the
    /// sums of colour and of squared luminance; the sums of the first surfaces' albedos and of squared luminance. Its
    /// usages are `STORAGE` and `COPY_SRC`.
    pub buffer: &'a Buffer,
}
