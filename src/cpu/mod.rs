//! The CPU reference: code in f64 that is as simple as possible, so that it can be seen to be correct.
//!
//! GPU results are judged against it. Each ray tests every sphere, and nothing but scene, camera and film is shared with
//! the GPU renderer. Where a choice is between clear and fast, it is clear.
//!
//! Where there is no device, the same code renders large scenes: with a [`SearchStructure`], rays test only spheres that they
//! may hit. The picture is the same, to the bit.

use std::ops::Range;

use crate::camera::View;
use crate::image::{Image, ImageTooLarge, LayerSet, NO_ID, NoMean, Pixel, RowMut};
use crate::parallel;
use crate::render::{
    Decision, InParts, Nearest, Picture, PrimarySettings, Progress, RenderSettings, SettingsError,
    Watch, to_the_end,
};

mod denoise;
mod light;
pub(crate) mod live;
mod pace;
mod search;
mod search_index;
#[cfg(test)]
mod search_tests;
mod shade;
mod sphere;
mod trace;

use pace::Pace;

pub use denoise::denoise;
pub use light::{Sample, SampledPicture, finish, radiance};
pub use search::{Search, SearchPlan, SearchStructure};
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
    /// The pictures of the parts of the samples have no mean.
    #[error(transparent)]
    Mean(#[from] NoMean),
    /// The caller ended the work.
    #[error("rendering was stopped")]
    Stopped,
}

/// Renders a picture.
///
/// With the integrator `primary`, each pixel shows what the ray through its centre hits. With the other integrators,
/// colour, alpha and albedo are means over the samples. Depth, normal, position and id come from the ray through the
/// pixel's centre and its first sphere, whatever its material. The variance is that of the mean luminance.
///
/// Given a reference to a scene, every ray tests every sphere. For scenes of more than a few spheres, build a
/// [`SearchStructure`] and give a reference to it: the picture is the same, to the bit, and soon finished.
///
/// Rows are rendered on all cores; the picture does not depend on how many there are.
///
/// # Errors
/// Returns an error if [`RenderSettings::check`] fails, or if there is not enough memory for the image.
pub fn render<'a>(
    search: impl Into<Search<'a>>,
    view: &View<'_>,
    settings: &RenderSettings,
    layers: LayerSet,
) -> Result<Image, RenderError> {
    let search = search.into();
    match settings.primary() {
        Some(primary) => {
            settings.check(search.scene())?;
            render_primary(search, view, &primary, layers)
        }
        None => SampledPicture::new(search, view, settings)?.render(layers),
    }
}

/// Renders a picture as [`render`] does, with the same pixels, and asks `watch` several times a second how to continue.
///
/// With lighting, every pixel gets its first sample before any gets its second, and so on in batches, so that the
/// caller may finish the picture with the samples that it has. Until then each pixel needs 72 bytes for its sums.
/// If a picture is finished within a batch, some rows have more samples than others, which the layer of samples tells.
///
/// # Errors
/// Returns an error as [`render`] does, if `watch` stops the work, or if it finishes the picture before every pixel has a
/// sample.
pub fn render_watched<'a>(
    search: impl Into<Search<'a>>,
    view: &View<'_>,
    settings: &RenderSettings,
    layers: LayerSet,
    watch: &mut Watch<'_>,
) -> Result<Picture, RenderError> {
    let search = search.into();
    SampledPicture::new(search, view, settings)?.render_watched(layers, watch)
}

/// Renders a lit picture in parts of `samples_per_part` samples, each a picture of its own, and takes the mean of all as
/// [`SampleMean`](crate::image::SampleMean) does: these are the bits of parts that several machines render. Else it is like
/// [`render_watched`], except that the picture cannot be finished early.
///
/// # Errors
/// As for [`render_watched`].
pub fn render_in_parts<'a>(
    search: impl Into<Search<'a>>,
    view: &View<'_>,
    settings: &RenderSettings,
    layers: LayerSet,
    samples_per_part: u32,
    watch: &mut Watch<'_>,
) -> Result<Picture, RenderError> {
    let search = search.into();
    let mut whole = InParts::new(settings.sampling.samples);
    for part in settings.unfinished_parts(samples_per_part) {
        let watch = &mut |progress: &Progress| to_the_end(watch(&whole.progress(progress)));
        let picture = render_watched(search, view, &part, settings.layers_for(layers), watch)?;
        whole.add(picture)?;
    }
    let picture = whole.picture().ok_or(RenderError::Stopped)?;
    Ok(Picture { image: finish(picture.image, settings, layers), ..picture })
}

fn render_primary(
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

/// Renders a picture by primary rays of a part of a scene ([`Scene::part`](crate::scene::Scene::part)), with what is
/// needed to put it together with those of the other parts. `None` for settings with light.
///
/// # Errors
/// Returns an error if [`RenderSettings::check`] fails, or if there is not enough memory for the image.
pub fn render_nearest<'a>(
    search: impl Into<Search<'a>>,
    view: &View<'_>,
    settings: &RenderSettings,
    layers: LayerSet,
) -> Result<Option<Nearest>, RenderError> {
    let search = search.into();
    settings.check(search.scene())?;
    let Some(primary) = settings.primary() else { return Ok(None) };
    let image = render_primary(search, view, &primary, layers)?;
    let width = view.film.width() as usize;
    let hits = parallel::map(image.color().len(), |at| {
        let pixel = [(at % width) as u32, (at / width) as u32];
        let hit = view.ray_through_center(pixel).and_then(|ray| trace(search, &ray));
        hit.map_or((f64::INFINITY, NO_ID), |hit| (hit.t, hit.id))
    });
    let (t, ids): (Vec<f64>, Vec<u32>) = hits.into_iter().unzip();
    let distances = t.iter().map(|t| *t as f32).collect();
    Ok(Nearest::new(image, t, ids, distances))
}

/// Renders a picture of primary rays, and asks after some rows how to continue.
fn primary_watched(
    search: Search<'_>,
    view: &View<'_>,
    primary: &PrimarySettings,
    layers: LayerSet,
    watch: &mut Watch<'_>,
) -> Result<Picture, RenderError> {
    let mut image = Image::new(view.film.width(), view.film.height(), layers)?;
    let height = image.height() as usize;
    Pace::new().run(height, |rows| {
        let is_done = rows.end == height;
        let part = rows.end as f64 / height as f64;
        for_rows(&mut image, rows, |pixel, i, row| {
            row.set(i, &primary_pixel(search, view, primary, pixel));
        });
        match watch(&Progress { samples: is_done.into(), total: 1, part, noise: None }) {
            Decision::GoOn | Decision::MeasureNoise => Ok(()),
            Decision::Finish if is_done => Ok(()),
            Decision::Finish | Decision::Stop => Err(RenderError::Stopped),
        }
    })?;
    Ok(Picture { image, samples: 1, noise: None, hits: None })
}

/// The pixel of the ray through its centre.
fn primary_pixel(
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
fn for_each_pixel(image: &mut Image, work: impl Fn([u32; 2], usize, &mut RowMut<'_>) + Sync) {
    let height = image.height() as usize;
    // Rows are borrowed in batches, because the references to a row's layers may need more memory than a narrow row.
    for start in (0..height).step_by(ROWS_AT_ONCE) {
        for_rows(image, start..(start + ROWS_AT_ONCE).min(height), &work);
    }
}

/// Calls `work` with each pixel of some rows, as [`for_each_pixel`] does.
fn for_rows(
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
    use rayon::prelude::*;
    rows.into_par_iter().enumerate().for_each(|(j, mut row)| render_row(j, &mut row));
}
