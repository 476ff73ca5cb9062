//! Recording paths for the checker: their state after every pass.

use crate::gpu::headless::lit_states::{Keep, States};
use crate::gpu::passes::lit::Moment;
use crate::verify::{
    LitInputs, LitRecording, PathRecording, PathState, RecordedFilm, RecordedSample,
    RecordedSurface,
};

/// Keeps the states of the paths of a sample.
pub(super) struct PathKeeper {
    recording: PathRecording,
    sample: RecordedSample,
}

impl PathKeeper {
    pub(super) fn new(given: LitInputs) -> Self {
        let recording = PathRecording { given, samples: Vec::new() };
        Self { recording, sample: RecordedSample::default() }
    }
}

impl Keep for PathKeeper {
    fn begin(&mut self, sample: u32) {
        self.recording.samples.clear();
        self.sample = RecordedSample { sample, ..RecordedSample::default() };
    }

    fn wants(&mut self, _: Moment) -> bool {
        true
    }

    fn keep(&mut self, moment: Moment, States { states, hits }: States) {
        let open = |states: &[PathState]| {
            states.iter().map(|state| state.slots[PathState::PENDING][3]).collect()
        };
        match (moment, self.sample.surfaces.last_mut()) {
            (Moment::Extended, _) => {
                self.sample.surfaces.push(RecordedSurface { hits, ..RecordedSurface::default() });
            }
            (Moment::Shaded, Some(surface)) => {
                surface.open = open(&states);
                surface.scattered = states;
            }
            (Moment::Occluded, Some(surface)) => surface.open = open(&states),
            _ => self.sample.start = states,
        }
    }

    fn end(&mut self, film: RecordedFilm) {
        self.sample.film = film;
        self.recording.samples.push(std::mem::take(&mut self.sample));
    }

    fn recording(&self) -> LitRecording<'_> {
        LitRecording::Paths(&self.recording)
    }
}
