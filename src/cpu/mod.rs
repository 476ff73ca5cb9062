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
use crate::render::{Decision, Nearest, Picture, RenderSettings, Watch};

mod denoise;
pub(crate) mod light;
mod pace;
mod primary;
mod search;
#[cfg(test)]
mod search_tests;
mod sphere;

use primary::primary_watched;

pub use denoise::denoise;
pub use light::{Sample, SampledPicture, finish};
pub use pace::RenderError;
pub use primary::{shade, trace};
pub use search::{Search, SearchPlan, SearchStructure};

/// Renders a picture.
///
/// With the integrator `primary`, each pixel shows what the ray through its centre hits. With the other integrators,
/// colour, alpha and albedo are means over the samples. Depth, normal, position and id come from the ray through the
/// pixel's centre and its first sphere, whatever its material. The variance is that of the mean luminance.
///
/// Given a reference to a scene, every ray tests every sphere. For scenes of more than a few spheres, build a
/// [`SearchStructure`] and give a reference to it: the picture is the same, to the bit, and soon finished.
///
/// Rows are rendered on all cores; the picture does not depend on how many there are. With lighting, each pixel needs
/// [`SampledPicture::BYTES_PER_PIXEL`] for its sums meanwhile.
///
/// # Errors
/// Returns an error if [`RenderSettings::check`] fails, or if there is not enough memory for the image.
pub fn render<'a>(
    search: impl Into<Search<'a>>,
    view: &View<'_>,
    settings: &RenderSettings,
    layers: LayerSet,
) -> Result<Image, RenderError> {
    Ok(render_watched(search, view, settings, layers, &mut |_| Decision::GoOn)?.image)
}

/// Renders a picture as [`render`] does, with the same pixels, and asks `watch` several times a second how to continue.
///
/// With lighting, every pixel gets its first sample before any gets its second, and so on in batches, so that the
/// caller may finish the picture with the samples that it has.
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
    match settings.primary() {
        Some(primary) => {
            settings.check(search.scene())?;
            primary_watched(search, view, &primary, layers, watch)
        }
        None => SampledPicture::new(search, view, settings)?.render(layers, watch),
    }
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
    if settings.primary().is_none() {
        return settings.check(search.scene()).map(|()| None).map_err(RenderError::from);
    }
    let image = render(search, view, settings, layers)?;
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
