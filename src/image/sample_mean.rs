//! The mean of pictures that have different samples of the same scene.

use super::color::luminance;
use super::{Image, ImageTooLarge, filled, optional};

/// The mean of pictures with different samples of one view, each with [`Sampling::first`](crate::render::Sampling) and a
/// number of samples of its own. Colour, alpha and albedo are means over all samples, summed in f64 in the order in which
/// the pictures are added; the variance is that of the mean luminance over all samples, and the other layers are those of
/// the first picture. The same pictures in the same order give the same bits on every machine.
#[derive(Clone, Debug)]
pub struct SampleMean {
    /// The first picture.
    image: Image,
    samples: u32,
    /// The sums, if there is more than one picture.
    sums: Option<Sums>,
}

/// Sums over the samples of all pixels, for the layers that there are.
#[derive(Clone, Debug)]
struct Sums {
    color: Vec<[f64; 3]>,
    alpha: Option<Vec<f64>>,
    albedo: Option<Vec<[f64; 3]>>,
    /// The sums of luminances and of their squares, for the variance.
    light: Option<Vec<[f64; 2]>>,
}

/// Pictures of which there is no mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoMean {
    /// They differ in size or layers.
    #[error("these pictures differ in size or layers, so they are not of one view")]
    OtherShape,
    /// The memory for the sums cannot be reserved.
    #[error(transparent)]
    TooLarge(#[from] ImageTooLarge),
}

impl SampleMean {
    /// The most bytes that each pixel needs beside the first picture, once there is a second.
    pub const BYTES_PER_PIXEL: u64 = 72;

    /// The mean of a single picture with `samples` samples for each pixel, at least one.
    #[must_use]
    pub fn new(image: Image, samples: u32) -> Self {
        Self { image, samples, sums: None }
    }

    /// Adds a picture with `samples` samples for each pixel, at least one.
    ///
    /// # Errors
    /// [`NoMean::OtherShape`] if it has another size or other layers, and [`NoMean::TooLarge`] if the memory for the sums
    /// cannot be reserved. Then nothing is added.
    pub fn add(&mut self, image: &Image, samples: u32) -> Result<(), NoMean> {
        let shape = |image: &Image| (image.width, image.height, image.layers());
        if shape(&self.image) != shape(image) {
            return Err(NoMean::OtherShape);
        }
        let mut sums = match self.sums.take() {
            Some(sums) => sums,
            None => {
                let mut sums = Sums::of(&self.image)?;
                sums.add(&self.image, self.samples);
                sums
            }
        };
        sums.add(image, samples);
        self.sums = Some(sums);
        self.samples += samples;
        Ok(())
    }

    /// The number of samples of each pixel.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The picture. With a single picture, it is that picture, to the bit.
    #[must_use]
    pub fn into_image(self) -> Image {
        let Self { mut image, samples, sums } = self;
        let Some(sums) = sums else {
            return image;
        };
        let count = f64::from(samples);
        let narrow = |sum: &f64| (sum / count) as f32;
        for (mean, sum) in image.color.iter_mut().zip(&sums.color) {
            *mean = sum.each_ref().map(narrow);
        }
        for (mean, sum) in image.alpha.iter_mut().flatten().zip(sums.alpha.iter().flatten()) {
            *mean = narrow(sum);
        }
        for (mean, sum) in image.albedo.iter_mut().flatten().zip(sums.albedo.iter().flatten()) {
            *mean = sum.each_ref().map(narrow);
        }
        for (of_pixel, [light, square]) in
            image.variance.iter_mut().flatten().zip(sums.light.iter().flatten())
        {
            let spread = (square / count - (light / count).powi(2)).max(0.0);
            *of_pixel = (spread / (count - 1.0)) as f32;
        }
        image.samples.iter_mut().flatten().for_each(|of_pixel| *of_pixel = samples);
        image
    }
}

impl Sums {
    /// Zeros for all pixels of a picture.
    fn of(image: &Image) -> Result<Self, ImageTooLarge> {
        let Image { width, height, .. } = *image;
        let pixels = image.color.len();
        let has = [image.alpha.is_some(), image.albedo.is_some(), image.variance.is_some()];
        let each =
            24 + has.iter().zip([8, 24, 16]).map(|(has, n)| u64::from(*has) * n).sum::<u64>();
        let too_large = ImageTooLarge { width, height, bytes: pixels as u64 * each };
        Ok(Self {
            color: filled(pixels, [0.0; 3]).ok_or(too_large)?,
            alpha: optional(has[0], pixels, 0.0).ok_or(too_large)?,
            albedo: optional(has[1], pixels, [0.0; 3]).ok_or(too_large)?,
            light: optional(has[2], pixels, [0.0; 2]).ok_or(too_large)?,
        })
    }

    /// Adds the sums that the means of a picture stand for.
    fn add(&mut self, image: &Image, samples: u32) {
        let count = f64::from(samples);
        let add = |sum: &mut f64, mean: f32| *sum += count * f64::from(mean);
        let add_each = |sums: &mut [f64; 3], means: &[f32; 3]| {
            sums.iter_mut().zip(means).for_each(|(sum, mean)| add(sum, *mean));
        };
        self.color.iter_mut().zip(&image.color).for_each(|(sums, means)| add_each(sums, means));
        let alpha = self.alpha.iter_mut().flatten().zip(image.alpha.iter().flatten());
        alpha.for_each(|(sum, mean)| add(sum, *mean));
        let albedo = self.albedo.iter_mut().flatten().zip(image.albedo.iter().flatten());
        albedo.for_each(|(sums, means)| add_each(sums, means));
        let light = self.light.iter_mut().flatten();
        let variances = image.variance.iter().flatten();
        for ((sums, variance), color) in light.zip(variances).zip(&image.color) {
            let mean = luminance(color.map(f64::from));
            // The variance of a mean is that of the samples divided by their number, and that of the samples is their
            // spread times n / (n - 1).
            let spread = (count - 1.0) * f64::from(*variance);
            *sums = [sums[0] + count * mean, sums[1] + count * (spread + mean * mean)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Averages, LayerSet};

    /// A pixel with samples of these luminances, as a renderer averages them.
    fn pixel(lights: &[f64]) -> Image {
        let count = lights.len() as f64;
        let mean = lights.iter().sum::<f64>() / count;
        let spread = lights.iter().map(|light| (light - mean).powi(2)).sum::<f64>() / count;
        let mut image = Image::new(1, 1, LayerSet::ALL).unwrap();
        image.rows_mut(0..1)[0].set_averages(
            0,
            &Averages {
                color: [mean as f32; 3],
                alpha: mean as f32,
                albedo: [mean as f32; 3],
                samples: lights.len() as u32,
                variance: if count > 1.0 { (spread / (count - 1.0)) as f32 } else { 0.0 },
            },
        );
        image
    }

    #[test]
    fn parts_have_the_mean_of_the_whole() {
        let lights: Vec<f64> = (0..23_u32).map(|n| f64::from(n * n % 17) / 8.0).collect();
        let whole = pixel(&lights);
        for parts in [1, 5, 7, 22, 23] {
            let mut chunks = lights.chunks(parts);
            let first = chunks.next().unwrap();
            let mut mean = SampleMean::new(pixel(first), first.len() as u32);
            chunks.for_each(|part| mean.add(&pixel(part), part.len() as u32).unwrap());
            assert_eq!(mean.samples(), 23);
            let found = mean.into_image();
            let near = |a: f32, b: f32| (a - b).abs() <= 2e-6 * b;
            assert!(near(found.color[0][1], whole.color[0][1]), "{parts}");
            assert!(near(found.alpha().unwrap()[0], whole.alpha().unwrap()[0]), "{parts}");
            assert!(near(found.albedo().unwrap()[0][2], whole.color[0][0]), "{parts}");
            assert!(near(found.variance().unwrap()[0], whole.variance().unwrap()[0]), "{parts}");
            assert_eq!(found.samples(), whole.samples());
        }
    }

    #[test]
    fn a_single_picture_stays_as_it_is() {
        let image = pixel(&[0.3, 0.1, 0.9]);
        assert_eq!(SampleMean::new(image.clone(), 3).into_image(), image);
    }

    #[test]
    fn other_shapes_are_refused() {
        let mut mean = SampleMean::new(pixel(&[0.5]), 1);
        for other in [Image::new(2, 1, LayerSet::ALL), Image::new(1, 1, LayerSet::COLOR)] {
            assert_eq!(mean.add(&other.unwrap(), 1), Err(NoMean::OtherShape));
        }
        assert_eq!(mean.samples(), 1);
    }
}
