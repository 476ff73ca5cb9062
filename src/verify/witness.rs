//! Light that a device found for some pixels and recorded sample by sample, as a witness that this light is legal: if every
//! stage of every sample is, a conforming device may find the sum. So the recording proves light whose bounds would be
//! too wide to say anything, whoever made it.

use crate::image::Image;
use crate::parallel;
use crate::recording::lighting::means;
use crate::recording::lit::{LitRecording, PixelSums};
use crate::verify::Checker;
use crate::verify::hit::LegalHits;
use crate::verify::lit::certificate::LitCertificate;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::upload;

/// Pixels whose samples were recorded.
#[derive(Clone, Debug)]
pub struct Witness {
    /// Column and row of each pixel.
    pixels: Vec<[u32; 2]>,
    /// The sums of each pixel so far; `None` if something was not legal.
    sums: Vec<Option<PixelSums>>,
    samples: u32,
}

impl Witness {
    /// Pixels, by column and row, without samples.
    #[must_use]
    pub fn new(pixels: Vec<[u32; 2]>) -> Self {
        let sums = vec![Some(PixelSums::default()); pixels.len()];
        Self { pixels, sums, samples: 0 }
    }

    /// Judges the next sample of each pixel. The recording must have the requested settings, and a rectangle around all
    /// pixels.
    pub fn add(&mut self, checker: &Checker<'_>, recording: &LitRecording) {
        let LitRecording { given, samples } = recording;
        let is_right =
            upload::check(checker.scene, &checker.candidates, given).is_ok() && recording.check_size().is_ok();
        let check = LitCheck::new(checker, given);
        let [x, y, width, height] = given.rectangle();
        for sample in samples {
            let is_next = is_right && sample.sample == self.samples;
            self.sums = parallel::map(self.pixels.len(), |at| {
                let [i, j] = self.pixels[at];
                let before = self.sums[at].filter(|_| is_next)?;
                let [i, j] = [i.checked_sub(x).filter(|i| *i < width)?, j.checked_sub(y).filter(|j| *j < height)?];
                let index = (j * width + i) as usize;
                let mut part = LitCertificate::default();
                check.judge_sample(sample, index, &mut part, &mut LegalHits::default());
                let is_legal = part.violations.is_empty() && sample.film.before[index] == before;
                is_legal.then(|| sample.film.after[index])
            });
            self.samples += 1;
        }
    }

    /// Writes the light of all pixels whose stages are legal to a picture before noise is removed. Returns how many they
    /// are.
    pub fn apply(&self, image: &mut Image) -> usize {
        let mut count = 0;
        let [width, height] = [image.width(), image.height()];
        for ([i, j], sums) in self.pixels.iter().zip(&self.sums) {
            if let Some(sums) = sums
                && (*i < width && *j < height)
            {
                let (averages, ..) = means(&sums.map(|four| four.map(f32::from_bits)), self.samples);
                let row = *j as usize;
                image.rows_mut(row..row + 1).iter_mut().for_each(|row| row.set_averages(*i as usize, &averages));
                count += 1;
            }
        }
        count
    }
}
