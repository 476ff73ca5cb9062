//! Recording studios for the checker: the state of every ray after every pass.

use crate::gpu::headless::lit_states::{Keep, LONGEST_SIDE, States, Wanted};
use crate::gpu::passes::lit::{LightingData, Moment};
use crate::verify::{
    LitInputs, LitRecording, PathState, RecordedFilm, StudioLight, StudioRecording, StudioSample,
    StudioSurface,
};

/// Maximum number of bytes of host memory that a sample takes.
const MAX_BYTES: u64 = 256 << 20;

/// Maximum number of rays that are checked of a sample, which takes a processor some 20 seconds.
const MAX_RAYS: u64 = 1 << 21;

/// Number of surfaces behind each other at which rays are counted. Few rays pass through more.
const FEW_SURFACES: u64 = 4;

/// The longest side in pixels of a rectangle with no more than so many bytes and rays.
pub(super) fn longest_side(lighting: &LightingData) -> u32 {
    let [lights, directions] =
        [lighting.parameters.light_count, lighting.parameters.occlusion_samples].map(u64::from);
    let batches = lights.div_ceil(32) + directions.div_ceil(32);
    let (state, hit, light) = (size_of::<PathState>() as u64, 16, 24);
    let surfaces = u64::from(lighting.max_surfaces);
    let bytes = surfaces * (state + hit + light * batches) + state + 96;
    let rays = surfaces.min(FEW_SURFACES) * (1 + lights + directions);
    let pixels = (MAX_BYTES / bytes.max(1)).min(MAX_RAYS / rays.max(1));
    // A multiple of the side of a workgroup.
    (pixels.isqrt() as u32 / 8 * 8).clamp(8, LONGEST_SIDE)
}

/// Keeps the states of the rays of a sample.
pub(super) struct StudioKeeper {
    recording: StudioRecording,
    sample: StudioSample,
    /// Whether a ray still passes through surfaces.
    is_any_alive: bool,
    /// Whether all surfaces were recorded that rays pass through.
    is_over: bool,
    /// The hidden lights or directions that are not yet added up.
    hidden: Option<Vec<u32>>,
}

/// Flag of a ray that passes on, `PATH_ALIVE` in `shaders/path/state.wgsl`.
const ALIVE: u32 = crate::light::codes::path::ALIVE;

impl StudioKeeper {
    pub(super) fn new(given: LitInputs) -> Self {
        Self {
            recording: StudioRecording { given, samples: Vec::new() },
            sample: StudioSample::default(),
            is_any_alive: true,
            is_over: false,
            hidden: None,
        }
    }

    fn is_any_alive(states: &[PathState]) -> bool {
        states.iter().any(|state| state.slots[0][3] & ALIVE != 0)
    }

    /// The light of a batch of lights or directions.
    fn light(&mut self, states: &States<'_>) -> StudioLight {
        let (left, radiance) = (hidden_of(states), states.slot(PathState::RADIANCE));
        let hidden = self.hidden.take().unwrap_or_else(|| vec![0; left.len()]);
        StudioLight { hidden, radiance, left }
    }
}

/// The bits of hidden lights.
fn hidden_of(states: &States<'_>) -> Vec<u32> {
    states.last_words(PathState::NORMAL)
}

impl Keep for StudioKeeper {
    fn begin(&mut self, sample: u32) {
        self.recording.samples.clear();
        self.sample = StudioSample { sample, ..StudioSample::default() };
        (self.is_any_alive, self.is_over, self.hidden) = (true, false, None);
    }

    /// Once every ray has ended, no state changes any more.
    fn wants(&mut self, moment: Moment) -> Option<Wanted> {
        self.is_over |= moment == Moment::Extended && !self.is_any_alive;
        let wanted = match moment {
            Moment::Extended => Wanted::Hits,
            Moment::Shadowed | Moment::Searched => Wanted::Slot(PathState::NORMAL),
            _ => Wanted::All,
        };
        (!self.is_over).then_some(wanted)
    }

    fn keep(&mut self, moment: Moment, states: &States<'_>) {
        let light =
            matches!(moment, Moment::Illuminated | Moment::Gathered).then(|| self.light(states));
        match (moment, self.sample.surfaces.last_mut(), light) {
            (Moment::Extended, ..) => {
                let hits = states.hits();
                self.sample.surfaces.push(StudioSurface { hits, ..StudioSurface::default() });
            }
            (Moment::Shadowed | Moment::Searched, ..) => self.hidden = Some(hidden_of(states)),
            (Moment::Shaded, Some(surface), _) => {
                surface.shaded = states.all();
                self.is_any_alive = Self::is_any_alive(&surface.shaded);
            }
            (Moment::Illuminated, Some(surface), Some(light)) => surface.lights.push(light),
            (Moment::Gathered, Some(surface), Some(light)) => surface.ambient.push(light),
            _ => self.sample.start = states.all(),
        }
    }

    fn end(&mut self, film: RecordedFilm) {
        self.sample.film = film;
        self.recording.samples.push(std::mem::take(&mut self.sample));
    }

    fn recording(&self) -> LitRecording<'_> {
        LitRecording::Studio(&self.recording)
    }
}
