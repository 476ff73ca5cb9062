//! Recording paths for the checker: their state after every pass.

use crate::gpu::headless::lit_states::{Keep, States, Wanted};
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

    fn wants(&mut self, moment: Moment) -> Option<Wanted> {
        Some(match moment {
            Moment::Extended => Wanted::Hits,
            Moment::Occluded => Wanted::Slot(PathState::PENDING),
            _ => Wanted::All,
        })
    }

    fn keep(&mut self, moment: Moment, states: &States<'_>) {
        match (moment, self.sample.surfaces.last_mut()) {
            (Moment::Extended, _) => {
                let hits = states.hits();
                self.sample.surfaces.push(RecordedSurface { hits, ..RecordedSurface::default() });
            }
            (Moment::Shaded, Some(surface)) => {
                surface.open = states.last_words(PathState::PENDING);
                surface.scattered = states.all();
            }
            (Moment::Occluded, Some(surface)) => {
                surface.open = states.last_words(PathState::PENDING);
            }
            _ => self.sample.start = states.all(),
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
