//! Lit pictures batch by batch of samples, so that the caller may finish them early. The pixels are those of
//! [`SampledPicture::render`], to the bit, because each adds its samples in the same order.

use std::ops::Range;

use super::SampledPicture;
use super::film_sums::{FilmSums, STRIP};
use crate::cpu::pace::Pace;
use crate::cpu::{RenderError, for_rows, primary_watched};
use crate::image::{Image, LayerSet};
use crate::render::{Decision, Picture, Progress, Watch, batch};

impl SampledPicture<'_> {
    /// Renders all pixels batch by batch of samples, and asks after parts of each batch how to continue; see
    /// [`crate::cpu::render_watched`].
    ///
    /// # Errors
    /// Returns an error if the image does not fit into memory, or if `watch` ends the work.
    pub fn render_watched(
        &self,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, RenderError> {
        let settings = self.context.settings;
        if let Some(primary) = settings.primary() {
            return primary_watched(self.context.search, &self.view, &primary, layers, watch);
        }
        let film = self.view.film;
        let mut image = Image::new(film.width(), film.height(), settings.layers_for(layers))?;
        let mut sums = FilmSums::new(film.width(), film.height())?;
        self.data_layers(&mut image, watch)?;
        self.gather(&mut sums, watch)?;
        sums.write(&mut image);
        let (samples, totals) = (sums.samples(), sums.totals());
        drop(sums);
        let image = self.finish(image, layers);
        Ok(Picture { image, samples, noise: totals.noise(samples), hits: Some(totals.opacity) })
    }

    /// Fills the layers of the ray through the centre of each pixel.
    fn data_layers(&self, image: &mut Image, watch: &mut Watch<'_>) -> Result<(), RenderError> {
        let has_data = image.rows_mut(0..1).first().is_some_and(|row| row.has_data());
        if !has_data {
            return Ok(());
        }
        // There is no sample yet, so the render cannot finish early.
        let total = self.context.settings.sampling.samples;
        let none = Progress { samples: 0, total, part: 0.0, noise: None };
        let height = image.height() as usize;
        Pace::new().run(height.div_ceil(STRIP), |strips| {
            for_rows(image, rows_of(&strips, height), |pixel, i, row| {
                row.set(i, &self.data(pixel));
            });
            match watch(&none) {
                Decision::Stop => Err(RenderError::Stopped),
                Decision::GoOn | Decision::MeasureNoise | Decision::Finish => Ok(()),
            }
        })
    }

    /// Takes samples until all are complete or the caller finishes the render. Then some strips may have more samples
    /// than others.
    fn gather(&self, sums: &mut FilmSums, watch: &mut Watch<'_>) -> Result<(), RenderError> {
        // Its own, because a sample may take many times as long as what the layers of data need.
        let mut pace = Pace::new();
        let total = self.context.settings.sampling.samples;
        let mut progress = Progress { samples: 0, total, part: 0.0, noise: None };
        let mut wants_noise = false;
        let count = sums.strips();
        while progress.samples < total {
            let first = progress.samples;
            let end = first + batch(first, total);
            let mut decision = Decision::GoOn;
            let done = pace.run(count, |strips| {
                let last = strips.end;
                sums.add(strips, first..end, |pixel, sample| self.sample(pixel, sample));
                if last == count {
                    return Ok(());
                }
                let in_batch = f64::from(end - first) * last as f64 / count as f64;
                progress.part = (f64::from(first) + in_batch) / f64::from(total);
                decision = watch(&progress);
                match decision {
                    Decision::GoOn | Decision::MeasureNoise => Ok(()),
                    Decision::Finish | Decision::Stop => Err(RenderError::Stopped),
                }
            });
            match done {
                Err(RenderError::Stopped) if decision == Decision::Finish && first > 0 => break,
                done => done?,
            }
            progress.samples = end;
            if wants_noise || decision == Decision::MeasureNoise {
                wants_noise = true;
                progress.noise = sums.totals().noise(end);
            }
            progress.part = f64::from(end) / f64::from(total);
            match watch(&progress) {
                Decision::GoOn => {}
                Decision::MeasureNoise => wants_noise = true,
                Decision::Finish => break,
                Decision::Stop => return Err(RenderError::Stopped),
            }
        }
        Ok(())
    }
}

/// The rows of some strips.
fn rows_of(strips: &Range<usize>, height: usize) -> Range<usize> {
    strips.start * STRIP..height.min(strips.end * STRIP)
}
