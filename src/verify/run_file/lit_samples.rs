//! Samples of a lit picture on their way into a run file: they are too many for the memory, so that they are kept in a
//! file until the recording is complete.

use std::cell::RefCell;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};

use super::container::in_pieces;
use super::numbers::{Array, Number};
use crate::verify::LitRecording;
use crate::verify::lit::{LitInputs, PathState, RecordedFilm};
use crate::verify::paths::RecordedSample;
use crate::verify::studio::StudioSample;

/// The largest number of samples in a run file.
pub const MAX_SAMPLES: u32 = 4096;

/// The largest number of bytes that a sample takes in memory. Recordings of [`Headless`](crate::gpu::Headless) take
/// less.
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
    /// No samples yet. They will be kept in `spool`, which has nothing else.
    #[must_use]
    pub fn new(spool: Box<dyn Spool>) -> Self {
        Self { spool: spool.into(), arrays: Vec::new(), end: 0, count: 0, given: None }
    }

    /// Forgets all samples.
    pub fn clear(&mut self) {
        (self.end, self.count, self.given) = (0, 0, None);
        self.arrays.clear();
    }

    /// Adds the samples of a recording. All recordings must be of one picture; their rectangles may differ.
    ///
    /// # Errors
    /// Returns an error if the samples cannot be kept, if they are of different pictures, too many or too large, or if
    /// a list does not have the size of the rectangle.
    pub fn add(&mut self, recording: LitRecording<'_>) -> io::Result<()> {
        let given = match recording {
            LitRecording::Paths(paths) => &paths.given,
            LitRecording::Studio(studio) => &studio.given,
        };
        match &mut self.given {
            Some(known) => {
                (known.origin, known.size) = (given.origin, given.size);
                if known != given {
                    return Err(io::Error::other("the samples are of different pictures"));
                }
            }
            None => self.given = Some(given.clone()),
        }
        let is_whole = match recording {
            LitRecording::Paths(paths) => paths.check_size(),
            LitRecording::Studio(studio) => studio.check_size(),
        };
        is_whole.map_err(io::Error::other)?;
        let place = [given.origin, given.size].concat();
        match recording {
            LitRecording::Paths(paths) => paths.samples.iter().try_for_each(|sample| {
                let RecordedSample { sample, start, surfaces, film } = sample;
                self.check(start.len(), surfaces.len(), 0)?;
                self.keep_sample([&[*sample], &place[..]].concat(), start, film)?;
                let shape = [surfaces.len(), start.len()];
                let hits = surfaces.iter().flat_map(|surface| &surface.hits);
                let states = surfaces.iter().flat_map(|surface| words_of(&surface.scattered));
                self.keep_hits(shape, hits.flatten().copied(), states)?;
                let open = surfaces.iter().flat_map(|surface| &surface.open);
                self.keep("open", &shape, open.copied())?;
                self.count += 1;
                Ok(())
            }),
            LitRecording::Studio(studio) => studio.samples.iter().try_for_each(|sample| {
                let StudioSample { sample, start, surfaces, film } = sample;
                let of_first = surfaces.first();
                let batches = of_first.map_or(0, |first| first.lights.len() + first.ambient.len());
                self.check(start.len(), surfaces.len(), batches)?;
                self.keep_sample([&[*sample], &place[..]].concat(), start, film)?;
                let shape = [surfaces.len(), start.len()];
                let hits = surfaces.iter().flat_map(|surface| &surface.hits);
                let states = surfaces.iter().flat_map(|surface| words_of(&surface.shaded));
                self.keep_hits(shape, hits.flatten().copied(), states)?;
                let lights = || {
                    surfaces
                        .iter()
                        .flat_map(|surface| surface.lights.iter().chain(&surface.ambient))
                };
                let shape = [surfaces.len(), batches, start.len()];
                self.keep("hidden", &shape, lights().flat_map(|light| &light.hidden).copied())?;
                let radiance = lights().flat_map(|light| light.radiance.as_flattened());
                let of_radiance = [&shape[..], &[4]].concat();
                self.keep("radiance", &of_radiance, radiance.copied())?;
                self.keep("left", &shape, lights().flat_map(|light| &light.left).copied())?;
                self.count += 1;
                Ok(())
            }),
        }
    }

    fn check(&self, pixels: usize, surfaces: usize, batches: usize) -> io::Result<()> {
        let bytes = bytes_in_memory([pixels, surfaces, batches].map(|count| count as u64));
        if self.count == MAX_SAMPLES {
            Err(io::Error::other(format!("a run file has room for {MAX_SAMPLES} samples")))
        } else if bytes > MAX_SAMPLE_BYTES {
            Err(io::Error::other("a sample of the light is too large for a run file"))
        } else {
            Ok(())
        }
    }

    fn keep_sample(
        &mut self,
        place: Vec<u32>,
        start: &[PathState],
        film: &RecordedFilm,
    ) -> io::Result<()> {
        let pixels = start.len();
        self.keep("place", &[place.len()], place.into_iter())?;
        self.keep("start", &[pixels, PathState::SLOTS, 4], words_of(start))?;
        for (name, sums) in [("before", &film.before), ("after", &film.after)] {
            self.keep(name, &[pixels, 3, 4], sums.iter().flatten().flatten().copied())?;
        }
        Ok(())
    }

    fn keep_hits(
        &mut self,
        [surfaces, pixels]: [usize; 2],
        hits: impl Iterator<Item = u32>,
        states: impl Iterator<Item = u32>,
    ) -> io::Result<()> {
        self.keep("hits", &[surfaces, pixels, 4], hits)?;
        self.keep("states", &[surfaces, pixels, PathState::SLOTS, 4], states)
    }

    /// Writes an array to the end of the spool.
    fn keep(
        &mut self,
        name: &str,
        shape: &[usize],
        words: impl Iterator<Item = u32>,
    ) -> io::Result<()> {
        let name = name_of(self.count, name);
        let spool = self.spool.get_mut();
        spool.seek(SeekFrom::Start(self.end))?;
        let mut out = BufWriter::new(spool);
        let mut end = self.end;
        for word in words {
            out.write_all(&word.to_le_bytes())?;
            end += u32::WIDTH as u64;
        }
        out.flush()?;
        self.arrays.push((name, shape.to_vec(), self.end));
        self.end = end;
        Ok(())
    }

    /// What the device was given, if there is a sample.
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
            let bytes = (shape.iter().product::<usize>() * u32::WIDTH) as u64;
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

fn words_of(states: &[PathState]) -> impl Iterator<Item = u32> {
    states.iter().flat_map(|state| state.slots).flatten()
}

/// The name of an array of a sample, the samples being counted from 0.
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
