//! The CPU reference: the simplest code that can be right, in f64.
//!
//! It is what the GPU is judged by. It shares scene, camera and film with the GPU path and nothing
//! else; where a choice is between clear and fast, it is clear.

use crate::camera::Camera;
use crate::film::Film;
use crate::image::{Image, ImageTooLarge, LayerSet, RowMut};
use crate::scene::Scene;
use crate::settings::Settings;

mod denoise;
mod light;
mod shade;
mod sphere;
mod trace;

pub use denoise::denoise;
pub use light::{LitError, LitPicture, Sample, radiance, render_lit};
pub use shade::shade;
pub use trace::trace;

/// How many rows are handed out together, to all cores.
const ROWS_AT_ONCE: usize = 4096;

/// Renders a picture with one ray through the centre of every pixel.
///
/// Rows run in parallel with the feature `parallel`; the picture does not depend on it.
///
/// # Errors
/// If the image does not fit into memory.
pub fn render(
    scene: &Scene,
    camera: &dyn Camera,
    film: &Film,
    settings: &Settings,
    layers: LayerSet,
) -> Result<Image, ImageTooLarge> {
    let mut image = Image::new(film.width(), film.height(), layers)?;
    let height = film.height() as usize;
    // In parts, because what a row's layers are borrowed with may be larger than a narrow row.
    for start in (0..height).step_by(ROWS_AT_ONCE) {
        let rows = image.rows_mut(start..(start + ROWS_AT_ONCE).min(height));
        for_each_row(rows, |j, row| {
            for i in 0..film.width() {
                let (column, line) = (f64::from(i) + 0.5, (start + j) as f64 + 0.5);
                let location = film.relative_location(column, line);
                let ray = camera.ray_in_world(location);
                let hit = camera.sees(location).then(|| trace(scene, &ray)).flatten();
                row.set(i as usize, &shade(scene, settings, &ray, hit.as_ref()));
            }
        });
    }
    Ok(image)
}

#[cfg(feature = "parallel")]
fn for_each_row(rows: Vec<RowMut<'_>>, render_row: impl Fn(usize, &mut RowMut<'_>) + Sync) {
    use rayon::prelude::*;
    rows.into_par_iter().enumerate().for_each(|(j, mut row)| render_row(j, &mut row));
}

#[cfg(not(feature = "parallel"))]
fn for_each_row(rows: Vec<RowMut<'_>>, render_row: impl Fn(usize, &mut RowMut<'_>)) {
    rows.into_iter().enumerate().for_each(|(j, mut row)| render_row(j, &mut row));
}
