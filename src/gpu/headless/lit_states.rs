//! Reading the states of paths and the sums of pixels between two dispatches, and keeping some for the checker.

use wgpu::Device;

use crate::gpu::error::GpuError;
use crate::gpu::headless::lit_flow::Flow;
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::passes::lit::{LightingData, LitFrame, Mode, Moment};
use crate::recording::lit::{
    LitInputs, LitRecording, PathState, PixelSums, RecordedFilm, RecordedSample, RecordedSurface, StudioLight,
};

/// Maximum side in pixels of the rectangle that is recorded. A sample of a path of eight surfaces then takes 130 MB of
/// host memory.
pub(super) const LONGEST_SIDE: u32 = 256;

/// The states of all paths between two dispatches.
pub(super) struct States<'a> {
    /// The slots on the device, one after the other.
    vectors: &'a [[u32; 4]],
    pixels: usize,
    slots: [SlotSource; PathState::SLOTS],
}

impl States<'_> {
    fn all(&self) -> Vec<PathState> {
        let of = |index| PathState { slots: self.slots.map(|source| self.vector(source, index)) };
        (0..self.pixels).map(of).collect()
    }

    /// The hit of each state.
    fn hits(&self) -> Vec<[u32; 4]> {
        self.from(SlotSource::Device(HIT)).collect()
    }

    /// One slot of each state.
    fn slot(&self, slot: usize) -> Vec<[u32; 4]> {
        self.from(self.slots[slot]).collect()
    }

    /// The last word of a slot of each state.
    fn last_words(&self, slot: usize) -> Vec<u32> {
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
            let [shadow, pending] =
                if mode.samples_light() { [7, 8].map(SlotSource::Device) } else { [no_direction, zero] };
            [shadow, pending, if mode.has_medium() { SlotSource::Device(9) } else { zero }]
        }
    };
    std::array::from_fn(|slot| match slot {
        0..HIT => SlotSource::Device(slot),
        _ => others[slot - HIT],
    })
}

/// Reads the states and sums that passes have changed.
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

    /// Reads the states that are kept after a pass, and calls `keep` with them.
    pub(super) async fn states(
        &self,
        flow: &mut Flow<'_>,
        moment: Moment,
        keep: impl FnOnce(&States<'_>),
    ) -> Result<(), GpuError> {
        let Self { pixels, slots, .. } = *self;
        let paths = &self.frame.paths;
        match self.only_slot(moment) {
            None => self.paths.record_copy(flow.encoder(), paths),
            Some(SlotSource::Constant(_)) => {}
            Some(SlotSource::Device(slot)) => {
                let size = (pixels * size_of::<[u32; 4]>()) as u64;
                let start = slot as u64 * size;
                flow.encoder().copy_buffer_to_buffer(paths, start, &self.paths.buffer, start, size);
            }
        }
        flow.finish(&[&self.paths.buffer]).await?;
        self.paths.read(|vectors: &[[u32; 4]]| keep(&States { vectors, pixels, slots }))
    }

    /// The only slot that [`Keeper::keep`] reads after a pass; `None` if it reads several.
    fn only_slot(&self, moment: Moment) -> Option<SlotSource> {
        match moment {
            Moment::Extended => Some(SlotSource::Device(HIT)),
            Moment::Occluded => Some(self.slots[PathState::PENDING]),
            Moment::Shadowed | Moment::Searched => Some(self.slots[PathState::NORMAL]),
            _ => None,
        }
    }
}

/// Maximum number of bytes of host memory that a sample takes.
const MAX_BYTES: u64 = 256 << 20;

/// Maximum number of checked rays of a sample. Checking them takes a processor some 20 seconds.
const MAX_RAYS: u64 = 1 << 21;

/// Number of surfaces behind each other whose rays are counted. Few rays pass through more.
const FEW_SURFACES: u64 = 4;

/// The longest side in pixels of a rectangle that stays within [`MAX_BYTES`] and [`MAX_RAYS`].
pub(super) fn longest_side(lighting: &LightingData) -> u32 {
    let [lights, directions] = [lighting.parameters.light_count, lighting.parameters.occlusion_samples].map(u64::from);
    let batches = lights.div_ceil(32) + directions.div_ceil(32);
    let (state, hit, light) = (size_of::<PathState>() as u64, 16, 24);
    let surfaces = u64::from(lighting.max_surfaces);
    let bytes = surfaces * (state + hit + light * batches) + state + 96;
    let rays = surfaces.min(FEW_SURFACES) * (1 + lights + directions);
    let pixels = (MAX_BYTES / bytes.max(1)).min(MAX_RAYS / rays.max(1));
    // A multiple of the side of a workgroup.
    (pixels.isqrt() as u32 / 8 * 8).clamp(8, LONGEST_SIDE)
}

/// Flag of a ray that passes on, `PATH_ALIVE` in `shaders/path/state.wgsl`.
const ALIVE: u32 = crate::light::codes::path::ALIVE;

/// Collects the recording of a sample.
pub(super) struct Keeper {
    recording: LitRecording,
    sample: RecordedSample,
    /// Whether all surfaces of a studio that rays pass through were recorded.
    is_over: bool,
    /// The hidden lights or directions of a studio that are not yet added up.
    hidden: Option<Vec<u32>>,
}

impl Keeper {
    pub(super) fn new(given: LitInputs) -> Self {
        let recording = LitRecording { given, samples: Vec::new() };
        Self { recording, sample: RecordedSample::default(), is_over: false, hidden: None }
    }

    /// Begins the sample with this index.
    pub(super) fn begin(&mut self, sample: u32) {
        self.recording.samples.clear();
        self.sample = RecordedSample { sample, ..RecordedSample::default() };
        (self.is_over, self.hidden) = (false, None);
    }

    /// Whether the states after a pass are kept. Once every ray of a studio has ended, no state changes any more.
    pub(super) fn wants(&mut self, moment: Moment) -> bool {
        if let (true, Moment::Extended, Some(before)) =
            (self.recording.given.is_studio(), moment, self.sample.surfaces.last())
        {
            self.is_over |= before.states.iter().all(|state| state.slots[0][3] & ALIVE == 0);
        }
        !self.is_over
    }

    /// Keeps the states after a pass.
    pub(super) fn keep(&mut self, moment: Moment, states: &States<'_>) {
        match (moment, self.sample.surfaces.last_mut()) {
            (Moment::Extended, _) => {
                let hits = states.hits();
                self.sample.surfaces.push(RecordedSurface { hits, ..RecordedSurface::default() });
            }
            (Moment::Shaded, Some(surface)) => {
                surface.states = states.all();
                if !self.recording.given.is_studio() {
                    surface.open = states.last_words(PathState::PENDING);
                }
            }
            (Moment::Occluded, Some(surface)) => {
                surface.open = states.last_words(PathState::PENDING);
            }
            (Moment::Shadowed | Moment::Searched, _) => {
                self.hidden = Some(states.last_words(PathState::NORMAL));
            }
            (Moment::Illuminated | Moment::Gathered, Some(surface)) => {
                let left = states.last_words(PathState::NORMAL);
                let light = StudioLight {
                    hidden: self.hidden.take().unwrap_or_else(|| vec![0; left.len()]),
                    radiance: states.slot(PathState::RADIANCE),
                    left,
                };
                match moment {
                    Moment::Illuminated => surface.lights.push(light),
                    _ => surface.ambient.push(light),
                }
            }
            _ => self.sample.start = states.all(),
        }
    }

    /// Keeps the sums of the pixels, and ends the sample.
    pub(super) fn end(&mut self, film: RecordedFilm) {
        self.sample.film = film;
        self.recording.samples.push(std::mem::take(&mut self.sample));
    }

    /// The recording of the sample.
    pub(super) fn recording(&self) -> &LitRecording {
        &self.recording
    }
}
