//! Computing a picture from the sums of its pixels.

use crate::gpu::passes::lit::records::FILM_SLOTS;
use crate::gpu::passes::tiles::Tile;
use crate::image::Image;
use crate::recording::lighting::means;
use crate::render::Totals;

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
