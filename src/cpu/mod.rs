//! The CPU reference: code in f64 that is as simple as possible, so that it can be seen to be correct.
//!
//! GPU results are judged against it. It shares only scene, camera and film with the GPU renderer. Where a choice is
//! between clear and fast, it is clear.

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

/// The number of rows that are processed together, on all cores.
const ROWS_AT_ONCE: usize = 4096;

/// Why no picture is rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The settings, or the materials of the scene, are not valid.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// There is not enough memory for the image.
    #[error(transparent)]
    Image(#[from] ImageTooLarge),
}

/// Renders a picture.
///
/// With the integrator `primary`, each pixel shows what the ray through its centre hits. With the other integrators,
/// colour, alpha and albedo are means over the samples. Depth, normal, position and id come from the ray through the
/// pixel's centre and its first sphere, whatever its material. The variance is that of the mean luminance.
///
/// Rows are rendered in parallel with the feature `parallel`; the picture does not depend on it.
///
/// # Errors
/// Returns an error if [`RenderSettings::check`] fails, or if there is not enough memory for the image.
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

/// The pixel of the ray through its centre.
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

/// Calls `work` with each pixel (column and row), its index in its row, and the row.
fn for_each_pixel(image: &mut Image, work: impl Fn([u32; 2], usize, &mut RowMut<'_>) + Sync) {
    let (width, height) = (image.width(), image.height() as usize);
    // Rows are borrowed in batches, because the references to a row's layers may need more memory than a narrow row.
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
