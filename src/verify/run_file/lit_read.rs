//! Reading of samples of lit pictures, one after the other.

use super::RunFileError;
use super::container::{Container, contradiction};
use super::lit_inputs;
use super::lit_samples::{MAX_SAMPLE_BYTES, MAX_SAMPLES, bytes_in_memory, name_of};
use crate::render::Integrator;
use crate::scene::Scene;
use crate::verify::lit::{LitInputs, PathState, RecordedFilm};
use crate::verify::paths::{RecordedSample, RecordedSurface};
use crate::verify::studio::{StudioLight, StudioSample, StudioSurface};
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

    fn states(self, array: &str, shape: &[usize]) -> Result<Vec<PathState>, RunFileError> {
        let shape = [shape, &[PathState::SLOTS]].concat();
        let slots = self.file.items::<u32, 4>(&self.name(array), &shape)?;
        let (all, _) = slots.as_chunks();
        Ok(all.iter().map(|slots| PathState { slots: *slots }).collect())
    }

    fn sums(self, array: &str, count: usize) -> Result<Vec<[[u32; 4]; 3]>, RunFileError> {
        let sums = self.file.items::<u32, 4>(&self.name(array), &[count, 3])?;
        Ok(sums.as_chunks().0.to_vec())
    }

    /// The numbers of surfaces and of pixels of a sample.
    fn shape(self, given: &LitInputs, batches: usize) -> Result<[usize; 2], RunFileError> {
        let shape = self.file.shape(&self.name("hits"))?;
        let surfaces = shape.first().copied().unwrap_or_default();
        let bytes = bytes_in_memory([given.pixels(), surfaces as u64, batches as u64]);
        if bytes > MAX_SAMPLE_BYTES {
            return Err(RunFileError::Memory { name: self.name("states"), bytes });
        }
        Ok([surfaces, given.pixels() as usize])
    }

    fn film(self, pixels: usize) -> Result<RecordedFilm, RunFileError> {
        Ok(RecordedFilm {
            before: self.sums("before", pixels)?,
            after: self.sums("after", pixels)?,
        })
    }

    fn paths(self, sample: u32, given: &LitInputs) -> Result<RecordedSample, RunFileError> {
        let Self { file, .. } = self;
        let shape @ [_, pixels] = self.shape(given, 0)?;
        let hits = file.items::<u32, 4>(&self.name("hits"), &shape)?;
        let states = self.states("states", &shape)?;
        let open = file.numbers::<u32>(&self.name("open"), &shape)?;
        let surfaces = hits.chunks(pixels).zip(states.chunks(pixels)).zip(open.chunks(pixels));
        let surface = |((hits, scattered), open): ((&[_], &[_]), &[_])| RecordedSurface {
            hits: hits.to_vec(),
            scattered: scattered.to_vec(),
            open: open.to_vec(),
        };
        Ok(RecordedSample {
            sample,
            start: self.states("start", &[pixels])?,
            surfaces: surfaces.map(surface).collect(),
            film: self.film(pixels)?,
        })
    }

    fn studio(self, sample: u32, given: &LitInputs) -> Result<StudioSample, RunFileError> {
        let Self { file, .. } = self;
        let batches = file.shape(&self.name("hidden"))?.get(1).copied().unwrap_or_default();
        let shape @ [surfaces, pixels] = self.shape(given, batches)?;
        let hits = file.items::<u32, 4>(&self.name("hits"), &shape)?;
        let states = self.states("states", &shape)?;
        let of_lights = [surfaces, batches, pixels];
        let hidden = file.numbers::<u32>(&self.name("hidden"), &of_lights)?;
        let radiance = file.items::<u32, 4>(&self.name("radiance"), &of_lights)?;
        let left = file.numbers::<u32>(&self.name("left"), &of_lights)?;
        let lights = hidden.chunks(pixels).zip(radiance.chunks(pixels)).zip(left.chunks(pixels));
        let mut lights = lights.map(|((hidden, radiance), left)| StudioLight {
            hidden: hidden.to_vec(),
            radiance: radiance.to_vec(),
            left: left.to_vec(),
        });
        // The others are of ambient light.
        let of_lights = (given.lighting.light_count.div_ceil(32) as usize).min(batches);
        let surfaces = hits.chunks(pixels).zip(states.chunks(pixels)).map(|(hits, shaded)| {
            let (hits, shaded) = (hits.to_vec(), shaded.to_vec());
            let mut next = |count| lights.by_ref().take(count).collect();
            let (lights, ambient) = (next(of_lights), next(batches - of_lights));
            StudioSurface { hits, shaded, lights, ambient }
        });
        Ok(StudioSample {
            sample,
            start: self.states("start", &[pixels])?,
            surfaces: surfaces.collect(),
            film: self.film(pixels)?,
        })
    }
}
