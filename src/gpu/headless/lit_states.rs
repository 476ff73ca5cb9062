//! Reading the states of paths and the sums of pixels between two dispatches.

use wgpu::Device;

use crate::gpu::error::GpuError;
use crate::gpu::headless::lit_flow::Flow;
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::passes::lit::{LitFrame, Mode, Moment};
use crate::verify::{LitRecording, PathState, PixelSums, RecordedFilm};

/// Maximum side in pixels of the rectangle that is recorded. A sample of a path of eight surfaces then takes 130 MB of
/// host memory.
pub(super) const LONGEST_SIDE: u32 = 256;

/// The states of all paths between two dispatches, of which only what is asked for is copied.
pub(super) struct States<'a> {
    /// The slots on the device, one after the other.
    vectors: &'a [[u32; 4]],
    pixels: usize,
    slots: [SlotSource; PathState::SLOTS],
}

impl States<'_> {
    /// The whole states.
    pub(super) fn all(&self) -> Vec<PathState> {
        let of = |index| PathState { slots: self.slots.map(|source| self.vector(source, index)) };
        (0..self.pixels).map(of).collect()
    }

    /// What the rays hit.
    pub(super) fn hits(&self) -> Vec<[u32; 4]> {
        self.from(SlotSource::Device(HIT)).collect()
    }

    /// One slot of each state.
    pub(super) fn slot(&self, slot: usize) -> Vec<[u32; 4]> {
        self.from(self.slots[slot]).collect()
    }

    /// The last word of a slot of each state.
    pub(super) fn last_words(&self, slot: usize) -> Vec<u32> {
        self.from(self.slots[slot]).map(|vector| vector[3]).collect()
    }

    fn from(&self, source: SlotSource) -> impl Iterator<Item = [u32; 4]> {
        (0..self.pixels).map(move |index| self.vector(source, index))
    }

    fn vector(&self, source: SlotSource, index: usize) -> [u32; 4] {
        match source {
            SlotSource::Device(slot) => self.vectors[slot * self.pixels + index],
            SlotSource::Constant(bits) => bits,
        }
    }
}

/// What is needed of the states of paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    Hits,
    /// One slot of each state.
    Slot(usize),
    All,
}

/// Keeps what is recorded of a sample.
pub(super) trait Keep {
    /// Begins the sample with this index.
    fn begin(&mut self, sample: u32);

    /// What is needed of the states after a pass, if anything.
    fn wants(&mut self, moment: Moment) -> Option<Wanted>;

    /// Keeps the states after a pass.
    fn keep(&mut self, moment: Moment, states: &States<'_>);

    /// Keeps the sums of the pixels, and ends the sample.
    fn end(&mut self, film: RecordedFilm);

    /// The recording of the sample.
    fn recording(&self) -> LitRecording<'_>;
}

/// Index of the slot of the hit, `HIT` in `shaders/path/state.wgsl`.
const HIT: usize = 6;

/// The source of a slot of a [`PathState`].
#[derive(Clone, Copy, Debug)]
enum SlotSource {
    /// A slot on the device, by its index.
    Device(usize),
    /// A constant, because the pictures need no such slot on the device.
    Constant([u32; 4]),
}

/// The sources of all slots, in the order of [`PathState`].
fn slot_sources(mode: Mode) -> [SlotSource; PathState::SLOTS] {
    let zero = SlotSource::Constant([0; 4]);
    let no_direction = SlotSource::Constant([0, 0, 1.0_f32.to_bits(), 0]);
    let others = match mode {
        Mode::Studio => [7, 8, 9].map(SlotSource::Device),
        Mode::Path(..) => {
            let [shadow, pending] = if mode.samples_light() {
                [7, 8].map(SlotSource::Device)
            } else {
                [no_direction, zero]
            };
            [shadow, pending, if mode.has_medium() { SlotSource::Device(9) } else { zero }]
        }
    };
    std::array::from_fn(|slot| match slot {
        0..HIT => SlotSource::Device(slot),
        _ => others[slot - HIT],
    })
}

/// Reads what passes have changed.
pub(super) struct Reader<'a> {
    frame: &'a LitFrame,
    paths: ReadableBuffer,
    pixels: usize,
    slots: [SlotSource; PathState::SLOTS],
}

impl<'a> Reader<'a> {
    /// A reader of the states and sums of a frame with this number of pixels.
    pub(super) fn new(device: &Device, frame: &'a LitFrame, pixels: u32, mode: Mode) -> Self {
        let paths = ReadableBuffer::new(device, "pinhole paths read-back", frame.paths.size());
        Self { frame, paths, pixels: pixels as usize, slots: slot_sources(mode) }
    }

    pub(super) async fn film(&self, flow: &mut Flow<'_>) -> Result<Vec<PixelSums>, GpuError> {
        let frame = self.frame;
        frame.record_copy_film(flow.encoder(), 0);
        frame.record_copy_spent(flow.encoder());
        flow.finish(&[&frame.film_back.buffer, &frame.spent_back.buffer]).await?;
        frame.read_spent()?;
        frame.film_back.read(|sums: &[PixelSums]| sums[..self.pixels].to_vec())
    }

    /// Reads what is wanted of the states, and calls `keep` with them.
    pub(super) async fn states(
        &self,
        flow: &mut Flow<'_>,
        wanted: Wanted,
        keep: impl FnOnce(&States<'_>),
    ) -> Result<(), GpuError> {
        let Self { pixels, slots, .. } = *self;
        let bytes = pixels as u64 * size_of::<[u32; 4]>() as u64;
        let of_slot = |slot: usize| slot as u64 * bytes..(slot as u64 + 1) * bytes;
        let range = match wanted {
            Wanted::Hits => of_slot(HIT),
            Wanted::Slot(slot) => match slots[slot] {
                SlotSource::Device(slot) => of_slot(slot),
                SlotSource::Constant(_) => 0..0,
            },
            Wanted::All => 0..self.paths.buffer.size(),
        };
        let paths = &self.frame.paths;
        let (start, size) = (range.start, range.end - range.start);
        flow.encoder().copy_buffer_to_buffer(paths, start, &self.paths.buffer, start, size);
        flow.finish(&[&self.paths.buffer]).await?;
        self.paths.read(|vectors: &[[u32; 4]]| keep(&States { vectors, pixels, slots }))
    }
}
