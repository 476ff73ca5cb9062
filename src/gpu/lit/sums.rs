//! From the sums of a tile's pixels to a picture.

use super::records::FILM_SLOTS;
use crate::color::luminance;
use crate::gpu::tiles::Tile;
use crate::image::Image;

/// Sums of one pixel: the three vectors of `shaders/film_sums.wgsl`.
type Sums = [[f32; 4]; FILM_SLOTS as usize];

/// Writes a tile's means into the layers that an image has. Gives the sum of all opacities.
pub(in crate::gpu) fn write(image: &mut Image, tile: Tile, sums: &[[f32; 4]], samples: u32) -> f64 {
    let (pixels, _) = sums.as_chunks::<{ FILM_SLOTS as usize }>();
    let [x, y] = tile.origin.map(|start| start as usize);
    let [width, height] = tile.size.map(|side| side as usize);
    let mut rows = image.rows_mut(y..y + height);
    let mut opacity = 0.0;
    for (row, pixels) in rows.iter_mut().zip(pixels.chunks(width)) {
        for (i, pixel) in (x..).zip(pixels) {
            let averages = averages(pixel, samples);
            opacity += f64::from(pixel[0][3]);
            row.set_averages(i, &averages);
        }
    }
    opacity
}

fn averages(pixel: &Sums, samples: u32) -> crate::image::Averages {
    let [[r, g, b, alpha], rest, [red, green, blue, square]] = pixel.map(|v| v.map(f64::from));
    let count = f64::from(samples.max(1));
    let sum = [r + rest[0], g + rest[1], b + rest[2]];
    let mean = luminance(sum) / count;
    let spread = ((square + rest[3]) / count - mean * mean).max(0.0);
    let narrow = |sum: f64| (sum / count) as f32;
    crate::image::Averages {
        color: sum.map(narrow),
        alpha: narrow(alpha).clamp(0.0, 1.0),
        albedo: [red, green, blue].map(narrow),
        samples,
        variance: if samples > 1 { spread / (count - 1.0) } else { 0.0 } as f32,
    }
}

/// The noise that is left: the root of the mean variance of pixels, over the mean luminance. `None` while nothing
/// can be said. `sums` are of variances and of luminances.
pub(in crate::gpu) fn noise([variance, light]: [f64; 2], pixels: u64, samples: u32) -> Option<f64> {
    let count = pixels as f64;
    (samples > 1 && light > 0.0).then(|| (variance / count).sqrt() / (light / count))
}
