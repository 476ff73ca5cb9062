//! The CPU reference: f64 code that is as simple as possible, so that readers can check it.
//!
//! GPU results are compared with it. Each ray tests every sphere. The scene, the camera, the film and, for light, the
//! random numbers and a few tables are shared with the GPU renderer. Clear code is preferred to fast code.
//!
//! Machines without a GPU use the same code for large scenes. With a [`SearchStructure`], rays test only spheres that
//! they may hit. The picture is the same, to the bit.

use crate::camera::View;
use crate::image::{Image, LayerSet, NO_ID};
use crate::parallel;
use crate::render::{Decision, NearestPicture, Picture, PrimarySettings, RenderSettings, Watch};
use crate::smooth::{SmoothPicture, first_half};

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
/// With the integrator `primary`, each pixel shows the surface that the ray through its centre hits. With the other
/// integrators, colour, alpha and albedo are means over the samples. Depth, normal, position and id come from the ray
/// through the pixel's centre and its first sphere, whatever its material. The variance is that of the mean luminance.
///
/// If `search` is a reference to a scene, every ray tests every sphere. For scenes of more than a few spheres, build a
/// [`SearchStructure`] and pass a reference to it. The picture is the same, to the bit, but takes far less time.
///
/// Rows are rendered on all cores. The picture does not depend on their number. With lighting, each pixel also needs
/// [`SampledPicture::BYTES_PER_PIXEL`] for its sums while it is rendered.
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

/// Renders a picture as [`render`] does, with the same pixels. Several times a second, it asks `watch` how to continue.
///
/// With lighting, every pixel gets its first sample before any gets its second, and so on in batches. So the caller can
/// finish the picture with the samples taken so far.
/// If a picture is finished within a batch, some rows have more samples than others, as the layer of samples shows.
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
        None => {
            let Some(smooth) = SmoothPicture::of(search.scene(), view, settings) else {
                return SampledPicture::new(search, view, settings)?.render(layers, watch);
            };
            settings.check(search.scene())?;
            let (of_ids, primary) = (smooth.view_of_ids(), PrimarySettings::default());
            let ids = primary_watched(search, &of_ids, &primary, smooth.layers(layers).0, &mut first_half(watch))?;
            smooth.draw(ids.image, layers, RenderError::Stopped, watch)
        }
    }
}

/// Renders a part of a scene ([`Scene::part`](crate::scene::Scene::part)) by primary rays, with the data needed to
/// merge the result with the pictures of the other parts. Returns `None` if the integrator is not `primary`.
///
/// # Errors
/// Returns an error if [`RenderSettings::check`] fails, or if there is not enough memory for the image.
pub fn render_nearest<'a>(
    search: impl Into<Search<'a>>,
    view: &View<'_>,
    settings: &RenderSettings,
    layers: LayerSet,
) -> Result<Option<NearestPicture>, RenderError> {
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
    Ok(NearestPicture::new(image, t, ids, distances))
}
