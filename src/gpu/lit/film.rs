//! What has been gathered of a lit picture: sums over samples, in f64.

use crate::color::luminance;
use crate::film::Film;
use crate::gpu::tiles::Tile;
use crate::image::{Image, ImageTooLarge};

/// Sums of one pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Pixel {
    /// Colour, and opacity.
    color: [f64; 4],
    /// Of the first surfaces' colours.
    albedo: [f32; 3],
    /// Of the square of the luminance.
    squared: f64,
}

/// Samples of every pixel, added up.
#[derive(Debug)]
pub(super) struct Sums {
    width: usize,
    pixels: Vec<Pixel>,
    samples: u32,
}

/// Bytes that a picture takes on the host beside its layers.
pub(super) const BYTES_PER_PIXEL: u64 = size_of::<Pixel>() as u64;

impl Sums {
    pub(super) fn new(film: &Film) -> Result<Self, ImageTooLarge> {
        let (width, height) = (film.width(), film.height());
        let too_large = ImageTooLarge {
            width,
            height,
            bytes: film.pixel_count().saturating_mul(BYTES_PER_PIXEL),
        };
        let count = usize::try_from(film.pixel_count()).map_err(|_| too_large)?;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| too_large)?;
        pixels.resize(count, Pixel::default());
        Ok(Self { width: width as usize, pixels, samples: 0 })
    }

    /// Adds a tile's sums: colour and opacity, slot by slot behind each other two of a pixel.
    pub(super) fn add(&mut self, tile: Tile, sums: &[[f32; 4]]) {
        let [x, y] = tile.origin.map(|start| start as usize);
        let tile_width = tile.size[0] as usize;
        for (index, sum) in
            sums.chunks_exact(2).take(tile_width * tile.size[1] as usize).enumerate()
        {
            let (i, j) = (index % tile_width, index / tile_width);
            let pixel = &mut self.pixels[(y + j) * self.width + x + i];
            for (all, more) in pixel.color.iter_mut().zip(sum[0]) {
                *all += f64::from(more);
            }
            for (all, more) in pixel.albedo.iter_mut().zip(sum[1]) {
                *all += more;
            }
            pixel.squared += f64::from(sum[1][3]);
        }
    }

    /// Takes note that every pixel has more samples.
    pub(super) fn count(&mut self, samples: u32) {
        self.samples += samples;
    }

    pub(super) fn samples(&self) -> u32 {
        self.samples
    }

    /// How many samples met something, if surfaces are opaque.
    pub(super) fn hits(&self) -> f64 {
        self.pixels.iter().map(|pixel| pixel.color[3]).sum()
    }

    /// The noise that is left: the root of the mean variance of pixels, over the mean luminance. `None` while
    /// nothing can be said.
    pub(super) fn noise(&self) -> Option<f64> {
        if self.samples < 2 {
            return None;
        }
        let variance: f64 = self.pixels.iter().map(|pixel| self.variance(pixel)).sum();
        let light: f64 =
            self.pixels.iter().map(|pixel| light_of(pixel) / f64::from(self.samples)).sum();
        let count = self.pixels.len() as f64;
        (light > 0.0).then(|| (variance / count).sqrt() / (light / count))
    }

    /// Of the mean.
    fn variance(&self, pixel: &Pixel) -> f64 {
        let count = f64::from(self.samples);
        if count < 2.0 {
            return 0.0;
        }
        let mean = light_of(pixel) / count;
        ((pixel.squared / count - mean * mean) / (count - 1.0)).max(0.0)
    }

    /// Writes the means into the layers that an image has.
    pub(super) fn write(&self, image: &mut Image) {
        let scale = 1.0 / f64::from(self.samples.max(1));
        for (index, pixel) in self.pixels.iter().enumerate() {
            let [r, g, b, alpha] = pixel.color.map(|sum| (sum * scale) as f32);
            image.color_mut()[index] = [r, g, b];
            if let Some(layer) = image.alpha_mut() {
                layer[index] = alpha.clamp(0.0, 1.0);
            }
            if let Some(layer) = image.albedo_mut() {
                layer[index] = pixel.albedo.map(|sum| (f64::from(sum) * scale) as f32);
            }
            if let Some(layer) = image.samples_mut() {
                layer[index] = self.samples;
            }
            if let Some(layer) = image.variance_mut() {
                layer[index] = self.variance(pixel) as f32;
            }
        }
    }
}

fn light_of(pixel: &Pixel) -> f64 {
    let [r, g, b, _] = pixel.color;
    luminance([r, g, b])
}
