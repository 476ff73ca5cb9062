//! Reading of samples of lit pictures, one after the other.

use super::RunFileError;
use super::container::{Container, contradiction};
use super::lit_inputs;
use super::lit_kept::Kept;
use super::lit_samples::{MAX_SAMPLE_BYTES, MAX_SAMPLES, bytes_in_memory, name_of};
use crate::render::Integrator;
use crate::scene::Scene;
use crate::verify::lit::{LitInputs, PathState, RecordedFilm};
use crate::verify::paths::RecordedSample;
use crate::verify::studio::{StudioLight, StudioSample};
use crate::verify::{LitRecording, PathRecording, Recording, StudioRecording};

/// The metadata key of the number of samples.
pub(super) const SAMPLES: &str = "lit_samples";

/// Reads all samples, and calls `each` with a recording of every one. Returns whether the file has light.
pub(super) fn each_sample(
    file: &Container<'_>,
    scene: &Scene,
    picture: &Recording,
    each: &mut dyn FnMut(LitRecording<'_>),
) -> Result<bool, RunFileError> {
    if !file.has_text(SAMPLES) {
        return Ok(false);
    }
    let count = file.whole(SAMPLES)?;
    if !(1..=MAX_SAMPLES).contains(&count) {
        return Err(contradiction(format!(
            "there are {count} samples; there must be 1 to {MAX_SAMPLES}"
        )));
    }
    let mut given = lit_inputs::read(file, picture)?;
    given.settings.check(scene).map_err(|error| contradiction(format!("the settings: {error}")))?;
    for index in 0..count {
        let sample = Sample { file, index };
        let number = sample.place(&mut given)?;
        match given.settings.integrator {
            Integrator::Studio(_) => {
                let samples = vec![sample.studio(number, &given)?];
                let recording = StudioRecording { given, samples };
                each(LitRecording::Studio(&recording));
                given = recording.given;
            }
            Integrator::Path(_) | Integrator::Primary(_) => {
                let samples = vec![sample.paths(number, &given)?];
                let recording = PathRecording { given, samples };
                each(LitRecording::Paths(&recording));
                given = recording.given;
            }
        }
    }
    Ok(true)
}

/// One sample in a file.
#[derive(Clone, Copy)]
struct Sample<'a, 'b> {
    file: &'a Container<'b>,
    index: u32,
}

impl Sample<'_, '_> {
    fn name(self, array: &str) -> String {
        name_of(self.index, array)
    }

    /// Reads the rectangle of a sample, and returns the sample's number.
    fn place(self, given: &mut LitInputs) -> Result<u32, RunFileError> {
        let [sample, x, y, width, height] =
            self.file.fixed::<u32, 1, 5>(&self.name("place"))?.map(|[number]| number);
        let is_inside = |first: u32, size: u32, side: u32| {
            size > 0 && first.checked_add(size).is_some_and(|end| end <= side)
        };
        let film = &given.film;
        if !is_inside(x, width, film.width()) || !is_inside(y, height, film.height()) {
            return Err(contradiction(format!(
                "the rectangle of sample {} is not in the picture",
                self.index
            )));
        }
        (given.origin, given.size) = ([x, y], [width, height]);
        Ok(sample)
    }

    fn states(self, array: &str, count: usize) -> Result<Vec<PathState>, RunFileError> {
        let slots = self.file.items::<u32, 4>(&self.name(array), &[count, PathState::SLOTS])?;
        let (all, _) = slots.as_chunks();
        Ok(all.iter().map(|slots| PathState { slots: *slots }).collect())
    }

    fn sums(self, array: &str, count: usize) -> Result<Vec<[[u32; 4]; 3]>, RunFileError> {
        let sums = self.file.items::<u32, 4>(&self.name(array), &[count, 3])?;
        Ok(sums.as_chunks().0.to_vec())
    }

    /// The states at the camera and the sums, and what is kept of all surfaces apart from light.
    fn common(
        self,
        given: &LitInputs,
        batches: usize,
    ) -> Result<(Vec<PathState>, RecordedFilm, Kept), RunFileError> {
        let Self { file, .. } = self;
        let length = |array| {
            let shape = file.shape(&self.name(array))?;
            Ok::<_, RunFileError>(shape.first().copied().unwrap_or_default())
        };
        let surfaces = length("counts")?;
        let bytes = bytes_in_memory([given.pixels(), surfaces as u64, batches as u64]);
        if bytes > MAX_SAMPLE_BYTES {
            return Err(RunFileError::Memory { name: self.name("states"), bytes });
        }
        let (pixels, kept) = (given.pixels() as usize, length("pixels")?);
        let film = RecordedFilm {
            before: self.sums("before", pixels)?,
            after: self.sums("after", pixels)?,
        };
        let kept = Kept {
            counts: file.numbers(&self.name("counts"), &[surfaces])?,
            pixels: file.numbers(&self.name("pixels"), &[kept])?,
            hits: file.items(&self.name("hits"), &[kept])?,
            states: self.states("states", kept)?,
            ..Kept::default()
        };
        Ok((self.states("start", pixels)?, film, kept))
    }

    fn paths(self, sample: u32, given: &LitInputs) -> Result<RecordedSample, RunFileError> {
        let (start, film, mut kept) = self.common(given, 0)?;
        kept.open = self.file.numbers(&self.name("open"), &[kept.pixels.len()])?;
        let surfaces = kept.paths(&start)?;
        Ok(RecordedSample { sample, start, surfaces, film })
    }

    fn studio(self, sample: u32, given: &LitInputs) -> Result<StudioSample, RunFileError> {
        let Self { file, .. } = self;
        let batches = file.shape(&self.name("hidden"))?.get(1).copied().unwrap_or_default();
        let (start, film, mut kept) = self.common(given, batches)?;
        let shape = [kept.pixels.len(), batches];
        kept.lights = StudioLight {
            hidden: file.numbers(&self.name("hidden"), &shape)?,
            radiance: file.items(&self.name("radiance"), &shape)?,
            left: file.numbers(&self.name("left"), &shape)?,
        };
        // The others are of ambient light.
        let lights = (given.lighting.light_count.div_ceil(32) as usize).min(batches);
        let surfaces = kept.studio(&start, [lights, batches - lights])?;
        Ok(StudioSample { sample, start, surfaces, film })
    }
}
