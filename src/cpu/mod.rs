//! The CPU reference: the simplest code that can be right, in f64.
//!
//! It is what the GPU is judged by. It shares scene, camera and film with the GPU path and nothing
//! else; where a choice is between clear and fast, it is clear.

use crate::camera::View;
use crate::image::{Image, ImageTooLarge, LayerSet, Pixel, RowMut};
use crate::render::{PrimarySettings, RenderSettings, SettingsError};
use crate::scene::Scene;

mod denoise;
mod light;
mod shade;
mod sphere;
mod trace;

pub use denoise::denoise;
pub use light::{Sample, SampledPicture, radiance};
pub use shade::shade;
pub use trace::trace;

/// How many rows are handed out together, to all cores.
const ROWS_AT_ONCE: usize = 4096;

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The settings, or the scene's materials, are refused.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The image does not fit into memory.
    #[error(transparent)]
    Image(#[from] ImageTooLarge),
}

/// Renders a picture.
///
/// By primary rays, each pixel is what the ray through its centre meets. Of a lit picture colour, alpha and albedo are
/// means of samples; depth, normal, position and id are those of the ray through the pixel's centre: of spheres alone,
/// whatever they are made of. The variance is that of the mean of luminances.
///
/// Rows run in parallel with the feature `parallel`; the picture does not depend on it.
///
/// # Errors
/// What [`RenderSettings::check`] refuses; if the image does not fit into memory.
pub fn render(
    scene: &Scene,
    view: &View<'_>,
    settings: &RenderSettings,
    layers: LayerSet,
) -> Result<Image, RenderError> {
    match settings.primary() {
        Some(primary) => {
            settings.check(scene)?;
            Ok(render_primary(scene, view, &primary, layers)?)
        }
        None => Ok(SampledPicture::new(scene, view, settings)?.render(layers)?),
    }
}

fn render_primary(
    scene: &Scene,
    view: &View<'_>,
    primary: &PrimarySettings,
    layers: LayerSet,
) -> Result<Image, ImageTooLarge> {
    let mut image = Image::new(view.film.width(), view.film.height(), layers)?;
    for_each_pixel(&mut image, |pixel, i, row| {
        row.set(i, &primary_pixel(scene, view, primary, pixel));
    });
    Ok(image)
}

/// What the ray through a pixel's centre says.
fn primary_pixel(
    scene: &Scene,
    view: &View<'_>,
    primary: &PrimarySettings,
    pixel: [u32; 2],
) -> Pixel {
    let ray = view.ray_through_center(pixel);
    let hit = ray.as_ref().and_then(|ray| trace(scene, ray));
    match (&ray, &hit) {
        (Some(ray), Some(hit)) => shade(scene, primary, ray, hit),
        _ => Pixel::miss(primary.background.to_array()),
    }
}

/// Does something for each pixel, which is column and row, in its row of the image and at its place there.
fn for_each_pixel(image: &mut Image, work: impl Fn([u32; 2], usize, &mut RowMut<'_>) + Sync) {
    let (width, height) = (image.width(), image.height() as usize);
    // In parts, because what a row's layers are borrowed with may be larger than a narrow row.
    for start in (0..height).step_by(ROWS_AT_ONCE) {
        let rows = image.rows_mut(start..(start + ROWS_AT_ONCE).min(height));
        for_each_row(rows, |j, row| {
            for i in 0..width {
                work([i, (start + j) as u32], i as usize, row);
            }
        });
    }
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
