//! One sample of a pixel, with its random numbers and its result. Also the sums over samples of all pixels, and the
//! means that follow from them.

use std::ops::Range;

use glam::DVec3;

use super::maps::luminance;
use crate::camera::sampling::{self, pixel_seed};
use crate::image::{Averages, Image, ImageTooLarge};
use crate::parallel;
use crate::render::Totals;

/// The result of one sample of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Radiance, in linear light.
    pub color: DVec3,
    /// The fraction of the background that the sample hides, from 0 to 1.
    pub alpha: f64,
    /// Colour of the first surface, each component at most 1. With the path integrator, this is the first surface that
    /// the path does not pass through. Zero for a miss, and for a shadow catcher.
    pub albedo: DVec3,
}

/// The address of a sample's random numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Address {
    seed: u32,
    sample: u32,
}

impl Address {
    pub(super) fn new(pixel: [u32; 2], sample: u32, seed: u32) -> Self {
        Self { seed: pixel_seed(pixel, seed), sample }
    }

    pub(super) fn pair(self, pair: u32) -> [u32; 2] {
        sampling::pair(self.seed, self.sample, pair)
    }

    /// The address of the j-th of `count` parts of the sample. Beyond 2³² parts, addresses repeat.
    pub(super) fn part(self, j: u32, count: u32) -> Self {
        let sample = self.sample.wrapping_mul(count).wrapping_add(j);
        Self { sample, ..self }
    }
}

/// The rows of a strip, and the width of a tile. Rays of near pixels meet the same spheres, which stay in the caches.
pub(super) const STRIP: usize = 8;

/// The sums over the samples of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PixelSums {
    color: DVec3,
    albedo: DVec3,
    alpha: f64,
    light: f64,
    square: f64,
}

impl PixelSums {
    fn add(&mut self, found: &Sample) {
        let luminance = luminance(found.color);
        self.color += found.color;
        self.albedo += found.albedo;
        self.alpha += found.alpha;
        self.light += luminance;
        self.square += luminance * luminance;
    }

    /// The means over `count` samples, and in f64 what is added up over all pixels.
    fn means(&self, count: u32) -> (Averages, Totals) {
        let Self { color, albedo, alpha, light, square } = *self;
        let n = f64::from(count);
        let spread = (square / n - (light / n).powi(2)).max(0.0);
        let variance = if count > 1 { spread / (n - 1.0) } else { 0.0 };
        let averages = Averages {
            color: (color / n).as_vec3().to_array(),
            alpha: (alpha / n) as f32,
            albedo: (albedo / n).as_vec3().to_array(),
            samples: count,
            variance: variance as f32,
        };
        (averages, Totals { opacity: alpha, variance, light: light / n, pixels: 1 })
    }
}

/// The sums of all pixels. They are stored strip by strip from the top, and tile by tile in a strip.
pub(super) struct FilmSums {
    size: [usize; 2],
    sums: Vec<PixelSums>,
    /// The number of samples of each strip.
    samples: Vec<u32>,
}

/// The sums of some adjacent pixels.
struct Tile<'a> {
    origin: [usize; 2],
    width: usize,
    sums: &'a mut [PixelSums],
}

impl FilmSums {
    /// Starts without samples. The error counts only the bytes of the sums.
    pub(super) fn new(width: u32, height: u32) -> Result<Self, ImageTooLarge> {
        let pixels = u64::from(width) * u64::from(height);
        let bytes = pixels.saturating_mul(size_of::<PixelSums>() as u64);
        let too_large = |_| ImageTooLarge { width, height, bytes };
        let pixels = usize::try_from(pixels).unwrap_or(usize::MAX);
        let sums = parallel::try_map(pixels, |_| PixelSums::default()).map_err(too_large)?;
        let size = [width, height].map(|side| side as usize);
        Ok(Self { size, sums, samples: vec![0; size[1].div_ceil(STRIP)] })
    }

    /// The number of strips.
    pub(super) fn strips(&self) -> usize {
        self.samples.len()
    }

    /// The number of samples that every pixel has.
    pub(super) fn samples(&self) -> u32 {
        self.samples.iter().copied().min().unwrap_or_default()
    }

    /// Adds samples to all pixels of some strips, on all cores.
    pub(super) fn add(
        &mut self,
        strips: Range<usize>,
        samples: Range<u32>,
        sample: impl Fn([u32; 2], u32) -> Sample + Sync + Send,
    ) {
        self.samples[strips.clone()].fill(samples.end);
        parallel::map_parts(self.tiles(strips), |Tile { origin, width, sums }| {
            for (index, sums) in sums.iter_mut().enumerate() {
                let pixel = [origin[0] + index % width, origin[1] + index / width];
                let pixel = pixel.map(|place| place as u32);
                samples.clone().for_each(|number| sums.add(&sample(pixel, number)));
            }
        });
    }

    fn tiles(&mut self, strips: Range<usize>) -> Vec<Tile<'_>> {
        let [width, height] = self.size;
        let start = strips.start * STRIP;
        let mut left = &mut self.sums[start * width..];
        let mut tiles = Vec::new();
        for top in strips.map(|strip| strip * STRIP) {
            let rows = STRIP.min(height - top);
            for x in (0..width).step_by(STRIP) {
                let width = STRIP.min(width - x);
                let (sums, rest) = left.split_at_mut(rows * width);
                tiles.push(Tile { origin: [x, top], width, sums });
                left = rest;
            }
        }
        tiles
    }

    /// The sums over all pixels.
    pub(super) fn totals(&self) -> Totals {
        let [width, height] = self.size;
        let of_strip = |strip: usize| {
            let rows = strip * STRIP..height.min((strip + 1) * STRIP);
            let mut totals = Totals::default();
            for sums in &self.sums[rows.start * width..rows.end * width] {
                totals.add(&sums.means(self.samples[strip]).1);
            }
            totals
        };
        let mut totals = Totals::default();
        parallel::map(self.strips(), of_strip).iter().for_each(|strip| totals.add(strip));
        totals
    }

    /// Writes the means to the layers of an image of the same size.
    pub(super) fn write(&self, image: &mut Image) {
        let [width, height] = self.size;
        for (top, samples) in (0..height).step_by(STRIP).zip(&self.samples) {
            let rows = STRIP.min(height - top);
            for (y, mut row) in image.rows_mut(top..top + rows).into_iter().enumerate() {
                for x in 0..width {
                    let tile = x - x % STRIP;
                    let inside = y * STRIP.min(width - tile) + x % STRIP;
                    let sums = &self.sums[top * width + tile * rows + inside];
                    row.set_averages(x, &sums.means(*samples).0);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::LayerSet;

    /// Every pixel gets its own samples, at any width and height of strips and tiles.
    #[test]
    fn every_pixel_has_its_place() {
        for [width, height] in [[1, 1], [8, 8], [7, 9], [17, 16], [30, 25]] {
            let mut film = FilmSums::new(width, height).unwrap();
            let sample = |[i, j]: [u32; 2], number| Sample {
                color: DVec3::from([i, j, number].map(f64::from)),
                alpha: 1.0,
                ..Sample::default()
            };
            let strips = film.strips();
            film.add(0..strips, 0..3, sample);
            assert_eq!(film.samples(), 3);
            film.add(0..1, 3..5, sample);
            let every = if strips == 1 { 5 } else { 3 };
            assert_eq!(film.samples(), every);
            let mut image = Image::new(width, height, LayerSet::ALL).unwrap();
            film.write(&mut image);
            let mut pixels = image.color().iter().zip(image.samples().unwrap());
            for (j, i) in (0..height).flat_map(|j| (0..width).map(move |i| (j, i))) {
                let (count, mean) = if j < 8 { (5, 2.0) } else { (3, 1.0) };
                assert_eq!(pixels.next(), Some((&[i as f32, j as f32, mean], &count)));
            }
            let totals = film.totals();
            assert_eq!(totals.pixels, u64::from(width) * u64::from(height));
            let taken: u32 = image.samples().unwrap().iter().sum();
            assert_eq!(totals.opacity as u32, taken);
        }
    }
}
