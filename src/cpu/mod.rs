//! The CPU reference: code in f64 that is as simple as possible, so that it can be seen to be correct.
//!
//! GPU results are judged against it. Each ray tests every sphere, and nothing but scene, camera and film is shared with
//! the GPU renderer. Where a choice is between clear and fast, it is clear.
//!
//! Where there is no device, the same code renders large scenes: with a [`SearchStructure`], rays test only spheres that they
//! may hit. The picture is the same, to the bit.

use crate::camera::View;
use crate::image::{Image, LayerSet, NO_ID};
use crate::parallel;
use crate::render::{Decision, Nearest, Picture, PrimarySettings, Progress, RenderSettings, Watch};

mod denoise;
mod error;
mod light;
pub(crate) mod live;
mod pace;
mod primary;
mod search;
mod search_index;
#[cfg(test)]
mod search_tests;
mod shade;
mod sphere;
mod trace;

use pace::Pace;
use primary::{for_rows, primary_pixel, render_primary};

pub use denoise::denoise;
pub use error::RenderError;
pub use light::{Sample, SampledPicture, finish, radiance};
pub use search::{Search, SearchPlan, SearchStructure};
pub use shade::shade;
pub use trace::trace;

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
