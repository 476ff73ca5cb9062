//! Pictures of one ray for each pixel, and loops over pixels.

use std::ops::Range;

use super::error::RenderError;
use super::search::Search;
use super::shade::shade;
use super::trace::trace;
use crate::camera::View;
use crate::image::{Image, LayerSet, Pixel, RowMut};
use crate::parallel::for_each;
use crate::render::PrimarySettings;

/// The number of rows that are processed together, on all cores.
const ROWS_AT_ONCE: usize = 4096;

pub(super) fn render_primary(
    search: Search<'_>,
    view: &View<'_>,
    primary: &PrimarySettings,
    layers: LayerSet,
) -> Result<Image, RenderError> {
    let mut image = Image::new(view.film.width(), view.film.height(), layers)?;
    for_each_pixel(&mut image, |pixel, i, row| {
        row.set(i, &primary_pixel(search, view, primary, pixel));
    });
    Ok(image)
}

/// The pixel of the ray through its centre.
pub(super) fn primary_pixel(
    search: Search<'_>,
    view: &View<'_>,
    primary: &PrimarySettings,
    pixel: [u32; 2],
) -> Pixel {
    let ray = view.ray_through_center(pixel);
    let hit = ray.as_ref().and_then(|ray| trace(search, ray));
    match (&ray, &hit) {
        (Some(ray), Some(hit)) => shade(search.scene(), primary, ray, hit),
        _ => Pixel::miss(primary.background.to_array()),
    }
}

/// Calls `work` with each pixel (column and row), its index in its row, and the row.
pub(super) fn for_each_pixel(
    image: &mut Image,
    work: impl Fn([u32; 2], usize, &mut RowMut<'_>) + Sync,
) {
    let height = image.height() as usize;
    // Rows are borrowed in batches, because the references to a row's layers may need more memory than a narrow row.
    for start in (0..height).step_by(ROWS_AT_ONCE) {
        for_rows(image, start..(start + ROWS_AT_ONCE).min(height), &work);
    }
}

/// Calls `work` with each pixel of some rows, as [`for_each_pixel`] does.
pub(super) fn for_rows(
    image: &mut Image,
    rows: Range<usize>,
    work: impl Fn([u32; 2], usize, &mut RowMut<'_>) + Sync,
) {
    let (width, start) = (image.width(), rows.start);
    for_each_row(image.rows_mut(rows), |j, row| {
        for i in 0..width {
            work([i, (start + j) as u32], i as usize, row);
        }
    });
}

fn for_each_row(rows: Vec<RowMut<'_>>, render_row: impl Fn(usize, &mut RowMut<'_>) + Sync) {
    for_each(rows.into_iter().enumerate().collect(), |(j, mut row)| render_row(j, &mut row));
}
