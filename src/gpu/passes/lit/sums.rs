//! Computing a picture from the sums of its pixels.

use crate::gpu::passes::lit::records::FILM_SLOTS;
use crate::gpu::passes::tiles::Tile;
use crate::image::color::luminance;
use crate::image::{Averages, Image};
use crate::render::Totals;

/// The sums of a pixel: the three vectors of `shaders/path/film_sums.wgsl`.
type Sums = [[f32; 4]; FILM_SLOTS as usize];

/// Writes the means of a tile to the layers of an image.
pub(crate) fn write(image: &mut Image, tile: Tile, sums: &[[f32; 4]], samples: u32) -> Totals {
    let (pixels, _) = sums.as_chunks::<{ FILM_SLOTS as usize }>();
    let [x, y] = tile.origin.map(|start| start as usize);
    let [width, height] = tile.size.map(|side| side as usize);
    let mut rows = image.rows_mut(y..y + height);
    let mut totals = Totals::default();
    for (row, pixels) in rows.iter_mut().zip(pixels.chunks(width)) {
        for (i, pixel) in (x..).zip(pixels) {
            let (averages, light, variance) = means(pixel, samples);
            totals.add(&Totals { opacity: pixel[0][3].into(), variance, light, pixels: 1 });
            row.set_averages(i, &averages);
        }
    }
    totals
}

/// The means of a pixel, its luminance, and the variance of its mean luminance.
fn means(pixel: &Sums, samples: u32) -> (Averages, f64, f64) {
    let [[r, g, b, alpha], rest, [red, green, blue, square]] = pixel.map(|v| v.map(f64::from));
    let count = f64::from(samples.max(1));
    let sum = [r + rest[0], g + rest[1], b + rest[2]];
    let light = luminance(sum) / count;
    let spread = ((square + rest[3]) / count - light * light).max(0.0);
    let variance = if samples > 1 { spread / (count - 1.0) } else { 0.0 };
    let narrow = |sum: f64| (sum / count) as f32;
    let averages = Averages {
        color: sum.map(narrow),
        alpha: narrow(alpha).clamp(0.0, 1.0),
        albedo: [red, green, blue].map(narrow),
        samples,
        variance: variance as f32,
    };
    (averages, light, variance)
}
