//! Writing samples of a lit picture into a run file, and reading them, one after the other. They do not fit into
//! memory, so a temporary file keeps them until the recording is complete.

use std::cell::RefCell;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};

use crate::recording::Recording;
use crate::recording::lit::{
    LitInputs, LitRecording, PathState, RecordedFilm, RecordedSample, RecordedSurface, StudioLight,
};
use crate::scene::Scene;
use crate::verify::run_file::container::{Array, Container, contradiction, in_pieces};
use crate::verify::run_file::error::RunFileError;
use crate::verify::run_file::lit_inputs;

/// The largest number of samples in a run file.
pub const MAX_SAMPLES: u32 = 4096;

/// The largest number of bytes that a sample takes in memory. Recordings of
/// [`Headless`](crate::gpu::Headless) take less.
pub(super) const MAX_SAMPLE_BYTES: u64 = 1 << 30;

/// A file or memory that keeps samples until they are written.
pub trait Spool: Read + Write + Seek {}

impl<S: Read + Write + Seek> Spool for S {}

/// Samples of a lit picture that are to be written into a run file.
pub struct LitSamples {
    spool: RefCell<Box<dyn Spool>>,
    /// The name, shape and position of each array.
    arrays: Vec<(String, Vec<usize>, u64)>,
    end: u64,
    count: u32,
    given: Option<LitInputs>,
}

impl LitSamples {
    /// Creates an empty list of samples. They will be kept in `spool`, which must be empty.
    #[must_use]
    pub fn new(spool: Box<dyn Spool>) -> Self {
        Self { spool: spool.into(), arrays: Vec::new(), end: 0, count: 0, given: None }
    }

    /// Removes all samples.
    pub fn clear(&mut self) {
        (self.end, self.count, self.given) = (0, 0, None);
        self.arrays.clear();
    }

    /// Adds the samples of a recording. All recordings must be of one picture. Their rectangles may differ.
    ///
    /// # Errors
    /// Returns an error if the samples cannot be kept, if they are of different pictures, too many or too large, or if
    /// a list does not have the size of the rectangle.
    pub fn add(&mut self, recording: &LitRecording) -> io::Result<()> {
        let given = &recording.given;
        match &mut self.given {
            Some(known) => {
                (known.origin, known.size) = (given.origin, given.size);
                if known != given {
                    return Err(io::Error::other("the samples are of different pictures"));
                }
            }
            None => self.given = Some(given.clone()),
        }
        recording.check_size().map_err(io::Error::other)?;
        let batches = if given.is_studio() { given.batches().iter().sum() } else { 0 };
        let ([x, y], [width, height]) = (given.origin, given.size);
        for RecordedSample { sample, start, surfaces, film } in &recording.samples {
            let (count, pixels) = (surfaces.len(), start.len());
            if self.count == MAX_SAMPLES {
                let words = format!("a run file has room for {MAX_SAMPLES} samples");
                return Err(io::Error::other(words));
            }
            let sizes = [pixels, count, batches].map(|size| size as u64);
            if bytes_in_memory(sizes) > MAX_SAMPLE_BYTES {
                return Err(io::Error::other("a sample of the light is too large for a run file"));
            }
            self.keep("place", &[5], [&[*sample, x, y, width, height][..]].into_iter())?;
            self.keep("start", &[pixels, PathState::SLOTS, 4], words_of(start))?;
            for (name, sums) in [("before", &film.before), ("after", &film.after)] {
                self.keep(name, &[pixels, 3, 4], [sums.as_flattened().as_flattened()].into_iter())?;
            }
            let hits = surfaces.iter().map(|surface| surface.hits.as_flattened());
            self.keep("hits", &[count, pixels, 4], hits)?;
            let states = surfaces.iter().flat_map(|surface| words_of(&surface.states));
            self.keep("states", &[count, pixels, PathState::SLOTS, 4], states)?;
            if given.is_studio() {
                let lights = || surfaces.iter().flat_map(|surface| surface.lights.iter().chain(&surface.ambient));
                let batches = if count > 0 { batches } else { 0 };
                let shape = [count, batches, pixels];
                self.keep("hidden", &shape, lights().map(|light| &light.hidden[..]))?;
                let radiance = lights().map(|light| light.radiance.as_flattened());
                self.keep("radiance", &[count, batches, pixels, 4], radiance)?;
                self.keep("left", &shape, lights().map(|light| &light.left[..]))?;
            } else {
                let open = surfaces.iter().map(|surface| &surface.open[..]);
                self.keep("open", &[count, pixels], open)?;
            }
            self.count += 1;
        }
        Ok(())
    }

    /// Writes an array to the end of the spool.
    fn keep<'a>(&mut self, name: &str, shape: &[usize], words: impl Iterator<Item = &'a [u32]>) -> io::Result<()> {
        let name = name_of(self.count, name);
        let spool = self.spool.get_mut();
        spool.seek(SeekFrom::Start(self.end))?;
        let mut out = BufWriter::new(spool);
        let mut end = self.end;
        for words in words {
            out.write_all(bytemuck::cast_slice(words))?;
            end += size_of_val(words) as u64;
        }
        out.flush()?;
        self.arrays.push((name, shape.to_vec(), self.end));
        self.end = end;
        Ok(())
    }

    /// The inputs of the device, if there is a sample.
    pub(super) fn given(&self) -> Option<&LitInputs> {
        self.given.as_ref().filter(|_| self.count > 0)
    }

    /// The number of samples.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }

    pub(super) fn arrays(&self) -> impl Iterator<Item = Array<'_>> {
        self.arrays.iter().map(move |(name, shape, start)| {
            let bytes = (shape.iter().product::<usize>() * size_of::<u32>()) as u64;
            Array::emitted::<u32>(name.clone(), shape.clone(), move |sink| {
                let mut spool = self.spool.borrow_mut();
                spool.seek(SeekFrom::Start(*start))?;
                in_pieces(&mut **spool, bytes, sink)
            })
        })
    }
}

impl std::fmt::Debug for LitSamples {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LitSamples").field("count", &self.count).finish_non_exhaustive()
    }
}

fn words_of(states: &[PathState]) -> impl Iterator<Item = &[u32]> {
    states.iter().map(|state| state.slots.as_flattened())
}

/// The name of an array of a sample. Samples are counted from 0.
pub(super) fn name_of(sample: u32, array: &str) -> String {
    format!("sample_{sample}_{array}")
}

/// The number of bytes that a sample takes in memory, by its numbers of pixels, surfaces, and batches of lights.
pub(super) fn bytes_in_memory([pixels, surfaces, batches]: [u64; 3]) -> u64 {
    let state = size_of::<PathState>() as u64;
    let of_surface = state.saturating_add(20).saturating_add(batches.saturating_mul(24));
    let of_pixel = surfaces.saturating_mul(of_surface).saturating_add(state + 96);
    pixels.saturating_mul(of_pixel)
}

/// The metadata key of the number of samples.
pub(super) const SAMPLES: &str = "lit_samples";

/// Reads all samples, and calls `each` with a recording of every sample. Returns whether the file has light.
pub(super) fn each_sample(
    file: &Container<'_>,
    scene: &Scene,
    picture: &Recording,
    each: &mut dyn FnMut(&LitRecording),
) -> Result<bool, RunFileError> {
    if !file.has_text(SAMPLES) {
        return Ok(false);
    }
    let count = file.whole(SAMPLES)?;
    if !(1..=MAX_SAMPLES).contains(&count) {
        return Err(contradiction(format!("there are {count} samples; there must be 1 to {MAX_SAMPLES}")));
    }
    let mut given = lit_inputs::read(file, picture)?;
    given.settings.check(scene).map_err(|error| contradiction(format!("the settings: {error}")))?;
    for index in 0..count {
        let sample = Sample { file, index };
        let number = sample.place(&mut given)?;
        let samples = vec![sample.read(number, &given)?];
        let recording = LitRecording { given, samples };
        each(&recording);
        given = recording.given;
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

    /// Reads the rectangle of a sample, and returns the index of the sample in its pixels.
    fn place(self, given: &mut LitInputs) -> Result<u32, RunFileError> {
        let [sample, x, y, width, height] = self.file.fixed::<u32, 1, 5>(&self.name("place"))?.map(|[number]| number);
        let is_inside =
            |first: u32, size: u32, side: u32| size > 0 && first.checked_add(size).is_some_and(|end| end <= side);
        let film = &given.film;
        if !is_inside(x, width, film.width()) || !is_inside(y, height, film.height()) {
            return Err(contradiction(format!("the rectangle of sample {} is not in the picture", self.index)));
        }
        (given.origin, given.size) = ([x, y], [width, height]);
        Ok(sample)
    }

    fn words(self, array: &str, shape: &[usize]) -> Result<Vec<u32>, RunFileError> {
        self.file.numbers(&self.name(array), shape)
    }

    fn vectors(self, array: &str, shape: &[usize]) -> Result<Vec<[u32; 4]>, RunFileError> {
        self.file.items(&self.name(array), shape)
    }

    fn states(self, array: &str, shape: &[usize]) -> Result<Vec<PathState>, RunFileError> {
        let shape = [shape, &[PathState::SLOTS]].concat();
        let slots = self.vectors(array, &shape)?;
        let (all, _) = slots.as_chunks();
        Ok(all.iter().map(|slots| PathState { slots: *slots }).collect())
    }

    fn sums(self, array: &str, count: usize) -> Result<Vec<[[u32; 4]; 3]>, RunFileError> {
        Ok(self.vectors(array, &[count, 3])?.as_chunks().0.to_vec())
    }

    fn shape(self, given: &LitInputs, batches: usize) -> Result<[usize; 2], RunFileError> {
        let shape = self.file.shape(&self.name("hits"))?;
        let surfaces = shape.first().copied().unwrap_or_default();
        let bytes = bytes_in_memory([given.pixels(), surfaces as u64, batches as u64]);
        if bytes > MAX_SAMPLE_BYTES {
            return Err(RunFileError::Memory { name: self.name("states"), bytes });
        }
        Ok([surfaces, given.pixels() as usize])
    }

    fn read(self, sample: u32, given: &LitInputs) -> Result<RecordedSample, RunFileError> {
        let pixels = given.pixels() as usize;
        let surfaces = self.surfaces(given)?;
        let start = self.states("start", &[pixels])?;
        let (before, after) = (self.sums("before", pixels)?, self.sums("after", pixels)?);
        Ok(RecordedSample { sample, start, surfaces, film: RecordedFilm { before, after } })
    }

    fn surfaces(self, given: &LitInputs) -> Result<Vec<RecordedSurface>, RunFileError> {
        let is_studio = given.is_studio();
        let batches = match is_studio {
            true => self.file.shape(&self.name("hidden"))?.get(1).copied().unwrap_or_default(),
            false => 0,
        };
        let shape @ [count, pixels] = self.shape(given, batches)?;
        let hits = self.vectors("hits", &shape)?;
        let states = self.states("states", &shape)?;
        let surfaces = hits.chunks(pixels).zip(states.chunks(pixels)).map(|(hits, states)| {
            let (hits, states) = (hits.to_vec(), states.to_vec());
            RecordedSurface { hits, states, ..RecordedSurface::default() }
        });
        let mut surfaces: Vec<_> = surfaces.collect();
        if !is_studio {
            let open = self.words("open", &shape)?;
            for (surface, open) in surfaces.iter_mut().zip(open.chunks(pixels)) {
                surface.open = open.to_vec();
            }
            return Ok(surfaces);
        }
        let of_lights = [count, batches, pixels];
        let hidden = self.words("hidden", &of_lights)?;
        let radiance = self.vectors("radiance", &of_lights)?;
        let left = self.words("left", &of_lights)?;
        let lights = hidden.chunks(pixels).zip(radiance.chunks(pixels)).zip(left.chunks(pixels));
        let mut lights = lights.map(|((hidden, radiance), left)| StudioLight {
            hidden: hidden.to_vec(),
            radiance: radiance.to_vec(),
            left: left.to_vec(),
        });
        // The others are of ambient light.
        let of_lights = given.batches()[0].min(batches);
        for surface in &mut surfaces {
            surface.lights = lights.by_ref().take(of_lights).collect();
            surface.ambient = lights.by_ref().take(batches - of_lights).collect();
        }
        Ok(surfaces)
    }
}
